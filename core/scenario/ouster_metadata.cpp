#include "core/scenario/ouster_metadata.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <string_view>
#include <utility>

#include "core/base/error.h"
#include "core/base/text.h"
#include "core/base/units.h"
#include "core/scenario/json_rules.h"
#include "core/scenario/json_source.h"

namespace railcast {
namespace {

// The sections of later firmware; the flat layout has the keys of all but the last at its root.
constexpr std::string_view kSensorInfo = "sensor_info";
constexpr std::string_view kBeamIntrinsics = "beam_intrinsics";
constexpr std::string_view kLidarIntrinsics = "lidar_intrinsics";
constexpr std::string_view kImuIntrinsics = "imu_intrinsics";
constexpr std::string_view kConfigParams = "config_params";
constexpr std::string_view kDataFormat = "lidar_data_format";
constexpr std::string_view kFlatDataFormat = "data_format";

constexpr double kMetresPerMillimetre = 1e-3;
constexpr std::size_t kMostPixelsPerColumn = 256;
constexpr std::size_t kMostColumnsPerPacket = 64;
constexpr std::size_t kMaxDatagramSize = 65'507;

/// A value of the metadata; null if there is none.
struct MetadataEntry {
  std::string pointer;
  const Json* json{};
};

/// Looks values up in either layout and collects the faults.
class MetadataReader {
 public:
  explicit MetadataReader(const Json& root)
      : root_(root), has_sections_(SectionOrNull(kBeamIntrinsics) != nullptr) {
    if (has_sections_ && root.contains("beam_altitude_angles")) {
      Add({"/beam_altitude_angles", &root["beam_altitude_angles"]},
          "must not stand beside /beam_intrinsics, which has it, too");
    }
  }

  [[nodiscard]] bool HasDataFormat() const {
    return SectionOrNull(has_sections_ ? kDataFormat : kFlatDataFormat) != nullptr;
  }
  [[nodiscard]] ErrorList& errors() { return errors_; }
  /// Faults that concern packets alone.
  [[nodiscard]] ErrorList& packet_errors() { return packet_errors_; }

  [[nodiscard]] MetadataEntry Find(std::string_view section, std::string_view key) const {
    const bool is_flat = !has_sections_ && section != kDataFormat;
    const std::string_view folder = has_sections_ ? section : kFlatDataFormat;
    const Json* const parent = is_flat ? &root_ : SectionOrNull(folder);
    MetadataEntry entry{(is_flat ? "" : PointerStep(folder)) + PointerStep(key)};
    if (parent == nullptr) return entry;
    const auto it = parent->find(std::string(key));
    if (it != parent->end() && !it->is_null()) entry.json = &*it;
    return entry;
  }

  void Add(const MetadataEntry& entry, const std::string& rule) { AddTo(errors_, entry, rule); }
  void AddOfPackets(const MetadataEntry& entry, const std::string& rule) {
    AddTo(packet_errors_, entry, rule);
  }

  /// A text; nothing if it is absent or not a string.
  [[nodiscard]] std::optional<std::string> Text(std::string_view section, std::string_view key) {
    const MetadataEntry entry = Find(section, key);
    if (entry.json == nullptr) return std::nullopt;
    if (entry.json->is_string()) return entry.json->get<std::string>();
    Add(entry, "must be a string");
    return std::nullopt;
  }

  /// A whole number within limits; nothing if it is absent or not one.
  [[nodiscard]] std::optional<std::uint32_t> Whole(const MetadataEntry& entry,
                                                   std::uint32_t least,
                                                   std::uint32_t most) {
    if (entry.json == nullptr) return std::nullopt;
    if (entry.json->is_number_unsigned()) {
      const auto number = entry.json->get<std::uint64_t>();
      if (number >= least && number <= most) return static_cast<std::uint32_t>(number);
    }
    Add(entry, "must be a whole number from " + NumberText(least) + " to " + NumberText(most));
    return std::nullopt;
  }
  [[nodiscard]] std::optional<std::uint32_t> RequiredWhole(std::string_view section,
                                                           std::string_view key,
                                                           std::uint32_t least,
                                                           std::uint32_t most) {
    const MetadataEntry entry = Find(section, key);
    if (entry.json == nullptr) Add(entry, "missing");
    return Whole(entry, least, most);
  }

  /// Numbers of at most this size. Nothing if they are absent or not a list of numbers.
  [[nodiscard]] std::optional<std::vector<double>> Numbers(std::string_view section,
                                                           std::string_view key,
                                                           double most) {
    const MetadataEntry entry = Find(section, key);
    if (entry.json == nullptr) return std::nullopt;
    if (!entry.json->is_array()) {
      Add(entry, "must be a list of numbers");
      return std::nullopt;
    }
    std::vector<double> numbers;
    for (const Json& element : *entry.json) {
      const double number = element.is_number() ? element.get<double>() : 2.0 * most;
      if (!(std::abs(number) <= most)) {
        Add({entry.pointer + PointerStep(NumberText(numbers.size())), &element},
            "must be a number from " + NumberText(-most) + " to " + NumberText(most));
        return std::nullopt;
      }
      numbers.push_back(number);
    }
    return numbers;
  }

  /// A transform in rows, its shift in mm; nothing if it is absent or none.
  [[nodiscard]] std::optional<Transform> RowsOfTransform(std::string_view section,
                                                         std::string_view key) {
    constexpr double kMost_mm = 10'000.0;
    const auto rows = Numbers(section, key, kMost_mm);
    if (!rows) return std::nullopt;
    const MetadataEntry entry = Find(section, key);
    if (rows->size() != 16) {
      Add(entry, "must have 16 numbers");
      return std::nullopt;
    }
    Eigen::Matrix4d matrix = Eigen::Matrix4d::Map(rows->data()).transpose();
    const Eigen::Matrix3d rotation = matrix.topLeftCorner<3, 3>();
    constexpr double kRounding = 1e-3;
    const bool is_rotation =
        (rotation * rotation.transpose() - Eigen::Matrix3d::Identity()).cwiseAbs().maxCoeff() <
            kRounding &&
        rotation.determinant() > 0.0;
    if (!is_rotation) {
      Add(entry, "must turn and shift, and nothing else");
      return std::nullopt;
    }
    return MakeTransform(rotation, kMetresPerMillimetre * matrix.topRightCorner<3, 1>());
  }

 private:
  static void AddTo(ErrorList& errors, const MetadataEntry& entry, const std::string& rule) {
    errors.Add(
        {entry.pointer, rule, entry.json == nullptr ? std::string() : ValueText(*entry.json)});
  }

  /// A section, unless it is something else: of commands that old firmware does not know, Ouster's
  /// programs note the error message.
  [[nodiscard]] const Json* SectionOrNull(std::string_view name) const {
    const auto it = root_.find(std::string(name));
    return it != root_.end() && it->is_object() ? &*it : nullptr;
  }

  const Json& root_;
  bool has_sections_;
  ErrorList errors_;
  ErrorList packet_errors_;
};

void ReadIdentity(MetadataReader& reader, OusterMetadata& metadata) {
  metadata.product_line = reader.Text(kSensorInfo, "prod_line").value_or("");
  const auto serial = reader.Text(kSensorInfo, "prod_sn");
  metadata.serial_number = serial ? ParseNumber<std::uint64_t>(*serial) : std::nullopt;
  constexpr std::uint32_t kMost24Bits = (1U << 24U) - 1;
  metadata.initialization_id =
      reader.Whole(reader.Find(kSensorInfo, "initialization_id"), 0, kMost24Bits);
}

// "1024x10": columns of a turn, and turns per second. The format of the packets has both, too.
void ReadMode(MetadataReader& reader, OusterMetadata& metadata) {
  const MetadataEntry entry = reader.Find(kConfigParams, "lidar_mode");
  const MetadataEntry rate = reader.Find(kDataFormat, "fps");
  if (entry.json == nullptr && rate.json != nullptr) {
    metadata.rate_hz = reader.Whole(rate, 1, 1000).value_or(1);
    metadata.columns_per_frame =
        reader.RequiredWhole(kDataFormat, "columns_per_frame", 1, 1U << 16U).value_or(0);
    return;
  }
  if (entry.json == nullptr) return reader.Add(entry, "missing");
  const std::string mode = entry.json->is_string() ? entry.json->get<std::string>() : "";
  const std::size_t cross = std::min(mode.find('x'), mode.size());
  const auto columns = ParseNumber<std::uint32_t>(std::string_view(mode).substr(0, cross));
  const auto rate_hz =
      ParseNumber<double>(std::string_view(mode).substr(std::min(cross + 1, mode.size())));
  constexpr std::uint32_t kMostColumns = 1U << 16U;  // Packets number them with 16 bits.
  constexpr double kMostRate_hz = 1000.0;
  // Each generation of sensors has modes of its own.
  if (!columns || !rate_hz || *columns == 0 || *columns > kMostColumns ||
      !(*rate_hz > 0.0 && *rate_hz <= kMostRate_hz)) {
    return reader.Add(entry, "must be COLUMNSxRATE, up to 65536 and 1000, such as 1024x10");
  }
  metadata.columns_per_frame = *columns;
  metadata.rate_hz = *rate_hz;
}

void ReadWindow(MetadataReader& reader, OusterMetadata& metadata) {
  metadata.column_window = {0, metadata.columns_per_frame - 1};
  const MetadataEntry entry = reader.Find(kDataFormat, "column_window");
  if (entry.json == nullptr) return;
  if (!entry.json->is_array() || entry.json->size() != 2) {
    return reader.Add(entry, "must be two columns");
  }
  for (std::size_t i = 0; i < 2; ++i) {
    const MetadataEntry end{entry.pointer + PointerStep(NumberText(i)), &(*entry.json)[i]};
    metadata.column_window[i] =
        reader.Whole(end, 0, metadata.columns_per_frame - 1).value_or(metadata.column_window[i]);
  }
}

void ReadProfile(MetadataReader& reader, OusterMetadata& metadata) {
  if (const auto name = reader.Text(kDataFormat, "udp_profile_lidar")) {
    const auto profile = ValueNamed<OusterProfile>(*name);
    if (!profile) {
      reader.AddOfPackets(
          reader.Find(kDataFormat, "udp_profile_lidar"),
          "must be " + Alternatives(NamesOf<OusterProfile>()) + " for packets to be read");
    }
    const bool is_dual = name->ends_with("_DUAL");
    metadata.profile = profile.value_or(is_dual ? OusterProfile::kDual : OusterProfile::kSingle);
  }
  metadata.has_fusa_header = metadata.profile == OusterProfile::kFusaDual;
  const auto header = reader.Text(kDataFormat, "header_type");
  if (!header || metadata.profile == OusterProfile::kLegacy) return;
  metadata.has_fusa_header = *header == "FUSA";
  if (*header == "FUSA" || *header == "STANDARD") return;
  reader.AddOfPackets(reader.Find(kDataFormat, "header_type"),
                      "must be STANDARD or FUSA for packets to be read");
}

/// The firmware's version in a revision such as "ousteros-image-prod-aries-v2.0.0-rc.2+2020";
/// nothing if it has none, as that of a development build.
std::optional<std::pair<unsigned, unsigned>> VersionIn(std::string_view revision) {
  const char* const end = revision.data() + revision.size();
  for (std::size_t i = revision.find('v'); i < revision.size(); i = revision.find('v', i + 1)) {
    std::pair<unsigned, unsigned> version;
    const auto major = std::from_chars(revision.data() + i + 1, end, version.first);
    if (major.ec != std::errc() || major.ptr == end || *major.ptr != '.') continue;
    if (std::from_chars(major.ptr + 1, end, version.second).ec == std::errc()) return version;
  }
  return std::nullopt;
}

// Ouster, firmware user manual 2.0, "lidar data packet format": reflectivity is a 16-bit unsigned
// integer whose calibration "has not currently been rigorously implemented"; that of 2.1 has 8
// bits. The profile is named from 2.2 on.
void ReadReflectivity(MetadataReader& reader, OusterMetadata& metadata) {
  if (metadata.profile != OusterProfile::kLegacy) return;
  for (const std::string_view key : {"build_rev", "image_rev"}) {
    const MetadataEntry entry = reader.Find(kSensorInfo, key);
    if (entry.json == nullptr || !entry.json->is_string()) continue;
    const auto version = VersionIn(entry.json->get_ref<const std::string&>());
    if (!version) continue;
    metadata.has_wide_reflectivity = *version < std::pair(2U, 1U);
    return;
  }
  metadata.has_wide_reflectivity = reader.Find(kDataFormat, "udp_profile_lidar").json == nullptr;
}

void ReadDataFormat(MetadataReader& reader, OusterMetadata& metadata) {
  constexpr std::uint32_t kUsualColumnsPerPacket = 16;
  metadata.columns_per_packet = kUsualColumnsPerPacket;
  if (!reader.HasDataFormat()) {
    metadata.column_window = {0, metadata.columns_per_frame - 1};
    return;
  }
  metadata.pixels_per_column =
      reader.RequiredWhole(kDataFormat, "pixels_per_column", 1, kMostPixelsPerColumn).value_or(0);
  const auto columns = reader.RequiredWhole(kDataFormat, "columns_per_frame", 1, 1U << 16U);
  if (columns && metadata.columns_per_frame > 0 && *columns != metadata.columns_per_frame) {
    reader.Add(reader.Find(kDataFormat, "columns_per_frame"),
               "must be " + NumberText(metadata.columns_per_frame) + " as of lidar_mode");
  }
  metadata.columns_per_packet =
      reader.RequiredWhole(kDataFormat, "columns_per_packet", 1, kMostColumnsPerPacket)
          .value_or(kUsualColumnsPerPacket);
  if (metadata.columns_per_frame % metadata.columns_per_packet != 0) {
    reader.AddOfPackets(
        reader.Find(kDataFormat, "columns_per_packet"),
        "must divide " + NumberText(metadata.columns_per_frame) + ", the columns of a turn");
  }
  if (metadata.columns_per_frame > 0) ReadWindow(reader, metadata);
  ReadProfile(reader, metadata);
}

std::vector<double> ReadAngles(MetadataReader& reader, std::string_view key, double most_deg) {
  const MetadataEntry entry = reader.Find(kBeamIntrinsics, key);
  if (entry.json == nullptr) {
    reader.Add(entry, "missing");
    return {};
  }
  return reader.Numbers(kBeamIntrinsics, key, most_deg).value_or(std::vector<double>());
}

void ReadBeams(MetadataReader& reader, OusterMetadata& metadata) {
  const std::size_t num_faults = reader.errors().size();
  const std::vector<double> altitudes_deg = ReadAngles(reader, "beam_altitude_angles", 90.0);
  const std::vector<double> azimuths_deg = ReadAngles(reader, "beam_azimuth_angles", 180.0);
  if (reader.errors().size() > num_faults) return;
  if (metadata.pixels_per_column == 0) {
    metadata.pixels_per_column = static_cast<std::uint32_t>(altitudes_deg.size());
  }
  const auto check_number = [&](std::string_view key, std::size_t number) {
    if (number == metadata.pixels_per_column && number > 0 && number <= kMostPixelsPerColumn)
      return;
    const std::string rule = metadata.pixels_per_column > 0 && number <= kMostPixelsPerColumn
                                 ? "must have " + NumberText(metadata.pixels_per_column) +
                                       " angles, one for each pixel of a column"
                                 : "must have from 1 to 256 angles";
    reader.errors().Add({reader.Find(kBeamIntrinsics, key).pointer, rule, NumberText(number)});
  };
  check_number("beam_altitude_angles", altitudes_deg.size());
  check_number("beam_azimuth_angles", azimuths_deg.size());
  if (reader.errors().size() > num_faults) return;
  // Sensors of firmware before 1.14 send 64 pixels, whatever the number of their beams. The angles
  // of the other pixels are 0; a single such pair is a beam that happens to point there.
  const auto is_blank = [&](std::size_t i) {
    return altitudes_deg[i] == 0.0 && azimuths_deg[i] == 0.0;
  };
  std::size_t num_blank = 0;
  for (std::size_t i = 0; i < altitudes_deg.size(); ++i) num_blank += is_blank(i) ? 1 : 0;
  for (std::size_t i = 0; i < altitudes_deg.size(); ++i) {
    if (num_blank > 1 && is_blank(i)) continue;
    metadata.beams.push_back({static_cast<std::uint16_t>(i), altitudes_deg[i], azimuths_deg[i]});
  }
  if (!metadata.beams.empty()) return;
  reader.errors().Add({reader.Find(kBeamIntrinsics, "beam_altitude_angles").pointer,
                       "must not be 0 for all beams", ""});
}

// By how far beams of a product line leave from the axis, where the metadata do not say so: those
// of later firmware for sensors of the same lines, and of the first generation (firmware before
// 1.14, which knew no other).
double UsualBeamOrigin_m(std::string_view product_line, bool is_first_generation) {
  if (is_first_generation) return 0.012163;
  if (product_line.starts_with("OS-0-")) return 0.02767;
  if (product_line.starts_with("OS-1-")) return 0.015806;
  if (product_line.starts_with("OS-2-")) return 0.013762;
  return 0.012163;
}

void ReadOrigin(MetadataReader& reader, OusterMetadata& metadata) {
  metadata.beam_origin_m = {UsualBeamOrigin_m(metadata.product_line, !reader.HasDataFormat()), 0.0};
  const MetadataEntry entry = reader.Find(kBeamIntrinsics, "lidar_origin_to_beam_origin_mm");
  if (entry.json != nullptr) {
    const double out_mm = entry.json->is_number() ? entry.json->get<double>() : -1.0;
    if (!(out_mm >= 0.0 && out_mm <= 1000.0)) {
      reader.Add(entry, "must be a number from 0 to 1000");
    }
    metadata.beam_origin_m[0] = kMetresPerMillimetre * out_mm;
  }
  if (const auto beam = reader.RowsOfTransform(kBeamIntrinsics, "beam_to_lidar_transform")) {
    metadata.beam_origin_m = {beam->translation().x(), beam->translation().z()};
    for (const double place_m : metadata.beam_origin_m) {
      if (std::abs(place_m) <= 1.0) continue;
      reader.Add(reader.Find(kBeamIntrinsics, "beam_to_lidar_transform"),
                 "must shift by at most 1000 mm");
    }
  }
}

void ReadTransforms(MetadataReader& reader, OusterMetadata& metadata) {
  // This holds for all sensors whose metadata do not say otherwise.
  constexpr double kLidarHeight_m = 0.03618;
  metadata.sensor_from_lidar =
      reader.RowsOfTransform(kLidarIntrinsics, "lidar_to_sensor_transform")
          .value_or(MakeTransform(RotationFromYawPitchRoll(RadFromDeg(180.0), 0.0, 0.0),
                                  {0.0, 0.0, kLidarHeight_m}));
  metadata.sensor_from_imu =
      reader.RowsOfTransform(kImuIntrinsics, "imu_to_sensor_transform")
          .value_or(MakeTransform(Eigen::Matrix3d::Identity(), {0.006253, -0.011775, 0.007645}));
}

void CheckPacketSize(MetadataReader& reader, const OusterMetadata& metadata) {
  const std::size_t size = OusterPacketSize(metadata);
  if (size <= kMaxDatagramSize) return;
  reader.packet_errors().Add({reader.Find(kDataFormat, "columns_per_packet").pointer,
                              "must give packets of at most 65507 bytes",
                              NumberText(size) + " bytes"});
}

std::size_t PixelSize(OusterProfile profile) {
  switch (profile) {
    case OusterProfile::kLegacy:
    case OusterProfile::kSingle:
      return 12;
    case OusterProfile::kDual:
      return 16;
    case OusterProfile::kLowRate:
      return 4;
    case OusterProfile::kLowRateDual:
    case OusterProfile::kFusaDual:
      break;
  }
  return 8;
}

/// Moves the keys of the flat layout that are known into the section in which they stand later.
void MoveKeys(std::string_view section,
              const std::vector<std::string>& keys,
              Json& flat,
              Json& to) {
  for (const std::string& key : keys) {
    if (!flat.contains(key)) continue;
    to[std::string(section)][key] = flat[key];
    flat.erase(key);
  }
}

}  // namespace

std::uint32_t OusterMetadata::num_window_columns() const {
  const std::uint32_t behind = column_window[1] + columns_per_frame - column_window[0];
  return behind % columns_per_frame + 1;
}

double OusterMetadata::range_offset_m() const {
  return std::hypot(beam_origin_m[0], beam_origin_m[1]);
}

std::size_t OusterPacketSize(const OusterMetadata& metadata) {
  const bool is_legacy = metadata.profile == OusterProfile::kLegacy;
  // Header and footer of a packet, then those of a column.
  const std::size_t around_packet = is_legacy ? 0 : 64;
  const std::size_t around_column = is_legacy ? 20 : 12;
  return around_packet +
         metadata.columns_per_packet *
             (around_column + metadata.pixels_per_column * PixelSize(metadata.profile));
}

OusterMetadata ParseOusterOfPackets(const std::string& text) {
  OusterMetadata metadata = ParseOusterMetadata(text);
  if (!metadata.packet_faults.empty()) throw InputError(metadata.packet_faults);
  return metadata;
}

OusterMetadata ParseOusterMetadata(const std::string& text) {
  const JsonText parsed = ParseJson(text);
  if (!parsed.json) throw InputError(parsed.syntax_error);
  if (!parsed.json->is_object()) {
    throw InputError("must be an object, the metadata of an Ouster sensor");
  }
  MetadataReader reader(*parsed.json);
  for (const std::string& pointer : parsed.duplicate_keys) {
    reader.errors().Add({pointer, "duplicate key", ""});
  }
  OusterMetadata metadata;
  ReadIdentity(reader, metadata);
  ReadMode(reader, metadata);
  ReadDataFormat(reader, metadata);
  ReadReflectivity(reader, metadata);
  ReadBeams(reader, metadata);
  ReadOrigin(reader, metadata);
  ReadTransforms(reader, metadata);
  CheckPacketSize(reader, metadata);
  reader.errors().ThrowIfAny();
  metadata.packet_faults = reader.packet_errors().faults();
  return metadata;
}

Json SectionsOfOusterMetadata(const std::string& text) {
  Json flat = *ParseJson(text).json;
  if (flat.contains(std::string(kBeamIntrinsics))) return flat;
  Json sections;
  MoveKeys(kSensorInfo,
           {"prod_line", "prod_pn", "prod_sn", "base_pn", "base_sn", "image_rev", "build_rev",
            "proto_rev", "build_date", "status", "initialization_id"},
           flat, sections);
  MoveKeys(kBeamIntrinsics,
           {"beam_altitude_angles", "beam_azimuth_angles", "lidar_origin_to_beam_origin_mm",
            "beam_to_lidar_transform"},
           flat, sections);
  MoveKeys(kImuIntrinsics, {"imu_to_sensor_transform"}, flat, sections);
  MoveKeys(kLidarIntrinsics, {"lidar_to_sensor_transform"}, flat, sections);
  MoveKeys(kConfigParams, {"lidar_mode", "udp_port_lidar", "udp_port_imu"}, flat, sections);
  if (flat.contains(std::string(kFlatDataFormat))) {
    sections[std::string(kDataFormat)] = flat[std::string(kFlatDataFormat)];
  }
  return sections;
}

}  // namespace railcast
