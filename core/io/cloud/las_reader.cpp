#include "core/io/cloud/las_reader.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>
#include <cstring>
#include <limits>
#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "core/base/error.h"
#include "core/base/input_file.h"
#include "core/base/join.h"
#include "core/base/text.h"
#include "core/base/text_encoding.h"
#include "core/base/text_number.h"
#include "railcast/remark.h"

namespace railcast {
namespace {

/// What the points of a format have behind what all have; places in bytes, 0 = none.
struct PointFormat {
  std::size_t num_bytes{};
  std::size_t time{};
  bool has_colour{};
  bool has_near_infrared{};
  bool has_wave{};

  [[nodiscard]] bool is_newer() const { return time == 22; }
};
constexpr std::array<PointFormat, 11> kPointFormats = {{{20, 0},
                                                        {28, 20},
                                                        {26, 0, true},
                                                        {34, 20, true},
                                                        {57, 20, false, false, true},
                                                        {63, 20, true, false, true},
                                                        {30, 22},
                                                        {36, 22, true},
                                                        {38, 22, true, true},
                                                        {59, 22, false, false, true},
                                                        {67, 22, true, true, true}}};

/// The bytes of a file, little-endian.
class Bytes {
 public:
  explicit Bytes(std::string_view bytes) : bytes_(bytes) {}

  template <typename Number>
  [[nodiscard]] Number At(std::uint64_t place) const {
    if (place > bytes_.size() || bytes_.size() - place < sizeof(Number)) {
      throw InputError("must have its whole header (got " + NumberText(bytes_.size()) + " bytes)");
    }
    Number number{};
    std::memcpy(&number, bytes_.data() + place, sizeof number);
    return number;
  }
  [[nodiscard]] std::string_view Text(std::uint64_t place, std::size_t size) const {
    return place < bytes_.size() ? bytes_.substr(place, size) : std::string_view();
  }
  [[nodiscard]] std::uint64_t size() const { return bytes_.size(); }

 private:
  std::string_view bytes_;
};

struct LasHeader {
  int minor_version{};
  std::size_t header_bytes{};
  std::uint64_t points_begin{};
  std::uint32_t num_records{};  ///< Variable length records behind the header.
  PointFormat format;
  std::size_t point_bytes{};
  std::uint64_t num_points{};
  std::array<double, 3> scale{};
  std::array<double, 3> offset_m{};
  std::array<std::array<double, 2>, 3> bounds_m{};  ///< Least and most; all 0 = not stated.
};

LasHeader ReadLasHeader(const Bytes& file) {
  if (file.Text(0, 4) != "LASF") throw InputError("must begin with LASF");
  LasHeader header;
  const int major = file.At<std::uint8_t>(24);
  header.minor_version = file.At<std::uint8_t>(25);
  if (major != 1 || header.minor_version > 4) {
    throw InputError("version: must be 1.0 to 1.4 (got " + NumberText(major) + "." +
                     NumberText(header.minor_version) + ")");
  }
  header.header_bytes = file.At<std::uint16_t>(94);
  header.points_begin = file.At<std::uint32_t>(96);
  header.num_records = file.At<std::uint32_t>(100);
  const int format = file.At<std::uint8_t>(104);
  if ((format & 0xC0) != 0) {
    throw InputError(
        "is compressed LAS (LAZ), which is not read: pdal translate or las2las makes "
        "a .las of it");
  }
  if (format > 10) throw InputError("point format: must be 0 to 10" + Got(format));
  header.format = kPointFormats.at(static_cast<std::size_t>(format));
  header.point_bytes = file.At<std::uint16_t>(105);
  if (header.point_bytes < header.format.num_bytes) {
    throw InputError("length of points: must be at least that of their format, " +
                     NumberText(header.format.num_bytes) + Got(header.point_bytes));
  }
  header.num_points = file.At<std::uint32_t>(107);
  // The older number is for programs that do not know the newer one.
  const auto newer_num = header.minor_version == 4 ? file.At<std::uint64_t>(247) : 0;
  if (newer_num > 0) header.num_points = newer_num;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    header.scale.at(axis) = file.At<double>(131 + 8 * axis);
    header.offset_m.at(axis) = file.At<double>(155 + 8 * axis);
    header.bounds_m.at(axis) = {file.At<double>(187 + 16 * axis), file.At<double>(179 + 16 * axis)};
    if (!(std::abs(header.scale.at(axis)) > 0.0) || !std::isfinite(header.scale.at(axis)) ||
        !std::isfinite(header.offset_m.at(axis))) {
      throw InputError("scale and offset: must be finite, the scale not 0");
    }
  }
  const std::size_t least = header.minor_version == 4 ? 375 : 227;
  if (header.header_bytes < least || header.points_begin < header.header_bytes ||
      header.points_begin > file.size()) {
    throw InputError("begin of points: must lie in the file, behind the header" +
                     Got(header.points_begin));
  }
  const std::uint64_t most = (file.size() - header.points_begin) / header.point_bytes;
  if (header.num_points > most || most > std::numeric_limits<std::uint32_t>::max()) {
    throw InputError("must hold the points that its header states, " +
                     NumberText(header.num_points) + Got(most));
  }
  return header;
}

[[noreturn]] void RefuseUnit(const std::string& got) {
  throw InputError("coordinates: must be metres in plan and height (got " + got +
                   "); pdal translate with filters.reprojection makes them such");
}

/// What a file says of its unit of length.
struct StatedUnit {
  bool is_metre = false;
  std::string codes{};  ///< Codes of coordinate systems whose units stand in EPSG's register alone.
};

/// Throws if the keys say that coordinates are no metres.
StatedUnit CheckGeoKeys(const Bytes& keys) {
  const std::size_t num = keys.size() / 8;
  // By the key of a system, the one of its unit: of projected and of vertical coordinates.
  const std::map<int, int> units = {{3072, 3076}, {4096, 4099}};
  std::map<int, int> values;
  for (std::size_t i = 1; i < num; ++i) {
    const int key = keys.At<std::uint16_t>(8 * i);
    const int value = keys.At<std::uint16_t>(8 * i + 6);
    if (keys.At<std::uint16_t>(8 * i + 2) != 0) continue;  // It stands elsewhere.
    if (key == 1024 && value == 2) RefuseUnit("degrees");
    if (key == 1024 && value == 3) RefuseUnit("places from the earth's centre");
    // Keys of units of projected and of vertical coordinates.
    const bool is_unit = key == 3076 || key == 4099;
    if (is_unit && value != 0 && value != 9001) RefuseUnit("unit EPSG:" + NumberText(value));
    values[key] = value;
  }
  // A geographic system that no projected one is made of.
  const bool is_projected = values[3072] != 0 || values[3076] != 0;
  if (values[1024] == 0 && values[2048] != 0 && !is_projected) RefuseUnit("degrees");
  constexpr int kUserDefined = 32767;
  StatedUnit unit_of{.is_metre = values[3076] != 0};
  std::string& codes = unit_of.codes;
  for (const auto& [system, unit] : units) {
    const int code = values[system];
    if (code == 0 || code == kUserDefined || values[unit] != 0) continue;
    codes += (codes.empty() ? "EPSG:" : ", EPSG:") + NumberText(code);
  }
  return unit_of;
}

/// Throws unless a unit is the metre or the degree, of the geographic system below the plan.
/// @param text Behind its bracket: "metre",1]...
void CheckWktUnit(std::string_view text) {
  const auto skip = [&](std::string_view passed) {
    text.remove_prefix(std::min(text.find_first_not_of(passed), text.size()));
  };
  skip(" \t\r\n");
  if (!text.starts_with('"')) return;
  const std::string_view name = text.substr(1, text.find('"', 1) - 1);
  text.remove_prefix(std::min(name.size() + 2, text.size()));
  skip(" \t\r\n,");
  const std::string_view number = text.substr(0, text.find_first_not_of("0123456789.eE+-"));
  if (number.empty()) return;
  const auto size = ParseTextNumber<double>(number);
  const bool is_angle = size && *size > 0.015 && *size < 0.018;
  if (!is_angle && size != 1.0) RefuseUnit(std::string(name));
}

/// Throws if the text of a coordinate system, of either version, states that coordinates are no
/// metres.
void CheckWkt(std::string_view text) {
  constexpr auto kGeodetic = std::to_array<std::string_view>(
      {"GEOGCS", "GEOCCS", "GEOGCRS", "GEOGRAPHICCRS", "GEODCRS", "GEODETICCRS"});
  bool is_geodetic = false, is_projected = false, is_from_centre = false;
  std::string word;
  for (std::size_t i = 0; i < text.size(); ++i) {
    const auto letter = static_cast<unsigned char>(text[i]);
    if (std::isalpha(letter) != 0) word += static_cast<char>(std::toupper(letter));
    if (std::isalpha(letter) != 0 || std::isspace(letter) != 0) continue;
    is_from_centre = is_from_centre || word == "GEOCCS" || word == "CARTESIAN";
    is_geodetic = is_geodetic || std::ranges::find(kGeodetic, word) != kGeodetic.end();
    is_projected =
        is_projected || word == "PROJCS" || word == "PROJECTEDCRS" || word.ends_with("PROJCRS");
    if (word == "UNIT" || word == "LENGTHUNIT") CheckWktUnit(text.substr(i + 1));
    word.clear();
    if (letter == '"') i = std::min(text.find('"', i + 1), text.size());
  }
  if (!is_geodetic || is_projected) return;
  RefuseUnit(is_from_centre ? "places from the earth's centre" : "degrees");
}

/// Throws if a record says that coordinates are no metres; else adds what it says.
void CheckRecord(std::string_view user, int id, std::string_view content, StatedUnit& unit) {
  if (!user.starts_with("LASF_Projection")) return;
  if (id == 2112) {
    CheckWkt(content);
    unit.is_metre = true;
  }
  if (id != 34735) return;
  const StatedUnit said = CheckGeoKeys(Bytes(content));
  unit.is_metre = unit.is_metre || said.is_metre;
  if (!unit.codes.empty() && !said.codes.empty()) unit.codes += ", ";
  unit.codes += said.codes;
}

/// As CheckRecord(), of all records, also of those behind the points.
StatedUnit CheckRecords(const Bytes& file, const LasHeader& header) {
  constexpr std::size_t kHead_bytes = 54;
  constexpr std::size_t kExtendedHead_bytes = 60;
  StatedUnit unit;
  std::uint64_t place = header.header_bytes;
  for (std::uint32_t i = 0; i < header.num_records; ++i) {
    if (place + kHead_bytes > header.points_begin) {
      throw InputError("records: must end before the points, " + NumberText(header.points_begin));
    }
    const std::size_t size = file.At<std::uint16_t>(place + 20);
    CheckRecord(file.Text(place + 2, 16), file.At<std::uint16_t>(place + 18),
                file.Text(place + kHead_bytes, size), unit);
    place += kHead_bytes + size;
  }
  if (header.minor_version < 4 || header.header_bytes < 247) return unit;
  place = file.At<std::uint64_t>(235);
  const auto num_extended = file.At<std::uint32_t>(243);
  for (std::uint32_t i = 0; i < num_extended; ++i) {
    const std::uint64_t rest = file.size() - std::min(file.size(), place);
    const auto size = rest < kExtendedHead_bytes ? 0 : file.At<std::uint64_t>(place + 20);
    if (rest < kExtendedHead_bytes || size > rest - kExtendedHead_bytes) {
      throw InputError("records behind the points: must lie in the file" + Got(file.size()));
    }
    CheckRecord(file.Text(place + 2, 16), file.At<std::uint16_t>(place + 18),
                file.Text(place + kExtendedHead_bytes, size), unit);
    place += kExtendedHead_bytes + size;
  }
  return unit;
}

/// Where the points and what belongs to them end: behind them stand waveforms and further records.
std::uint64_t EndOfPoints(const Bytes& file, const LasHeader& header) {
  std::uint64_t end = file.size();
  const auto limit = [&](std::uint64_t begin) {
    if (begin >= header.points_begin && begin > 0) end = std::min(end, begin);
  };
  if (header.minor_version >= 3 && header.header_bytes >= 235) limit(file.At<std::uint64_t>(227));
  if (header.minor_version >= 4 && file.At<std::uint32_t>(243) > 0) {
    limit(file.At<std::uint64_t>(235));
  }
  return end;
}

Cloud EmptyCloud(const LasHeader& header) {
  Cloud cloud{.height = 1, .width = 0, .fields = {}, .point_step = 0, .is_dense = true, .data = {}};
  for (const char* axis : {"x", "y", "z"}) cloud.AddField(axis, NumberType::kDouble);
  if (header.format.time > 0) cloud.AddField("gps_time", NumberType::kDouble);
  cloud.AddField("intensity", NumberType::kUint16);
  cloud.AddField("point_source_id", NumberType::kUint16);
  cloud.AddField("scan_angle", NumberType::kFloat);
  for (const char* name : {"return_index", "return_count", "label", "user_data", "flags"}) {
    cloud.AddField(name, NumberType::kUint8);
  }
  return cloud;
}

/// Appends a point; nothing if it is withheld.
/// @return Whether it was appended.
bool Append(const Bytes& point, const LasHeader& header, Cloud& cloud) {
  const bool is_newer = header.format.is_newer();
  const int returns = point.At<std::uint8_t>(14);
  const int second = point.At<std::uint8_t>(15);
  // As the newer formats have them: synthetic, key, withheld, overlap, channel, direction, edge.
  const int flags = is_newer ? second : (second >> 5) | (returns & 0xC0);
  constexpr int kWithheld = 0x04;
  if ((flags & kWithheld) != 0) return false;
  const auto put = [&](auto number) {
    const auto* begin = reinterpret_cast<const std::uint8_t*>(&number);
    cloud.data.insert(cloud.data.end(), begin, begin + sizeof number);
  };
  for (std::size_t axis = 0; axis < 3; ++axis) {
    put(point.At<std::int32_t>(4 * axis) * header.scale.at(axis) + header.offset_m.at(axis));
  }
  if (header.format.time > 0) put(point.At<double>(header.format.time));
  put(point.At<std::uint16_t>(12));
  put(point.At<std::uint16_t>(is_newer ? 20 : 18));
  put(is_newer ? 0.006F * point.At<std::int16_t>(18)
               : static_cast<float>(point.At<std::int8_t>(16)));
  const int number = is_newer ? returns & 0x0F : returns & 0x07;
  put(static_cast<std::uint8_t>(std::max(number, 1) - 1));
  put(static_cast<std::uint8_t>(is_newer ? returns >> 4 : (returns >> 3) & 0x07));
  put(is_newer ? point.At<std::uint8_t>(16) : static_cast<std::uint8_t>(second & 0x1F));
  put(point.At<std::uint8_t>(17));
  put(static_cast<std::uint8_t>(flags));
  ++cloud.width;
  return true;
}

/// Throws if more than 1 % of the points are outside the bounds that the header states: its scale
/// or offset is wrong, or the bounds are.
void CheckBounds(const LasHeader& header, const Cloud& cloud) {
  constexpr double kNear_m = 0.02;
  constexpr std::size_t kMostWrong = 100;
  if (header.bounds_m == decltype(header.bounds_m){}) return;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const auto [least, most] = header.bounds_m.at(axis);
    std::size_t num_outside = 0;
    double outside_m = 0.0;
    VisitField(cloud, cloud.fields.at(axis), [&](std::size_t, auto value) {
      const auto value_m = static_cast<double>(value);
      if (value_m >= least - kNear_m && value_m <= most + kNear_m) return;
      ++num_outside;
      outside_m = value_m;
    });
    if (num_outside * kMostWrong <= cloud.num_points()) continue;
    throw InputError(cloud.fields.at(axis).name + ": must be within the bounds of the header, " +
                     NumberText(least) + " to " + NumberText(most) + Got(outside_m) +
                     "; pdal translate writes the header anew, if scale and offset are right");
  }
}

/// The fields that ReadLas() does not give.
std::vector<std::string> FieldsLeftOut(const LasHeader& header) {
  std::vector<std::string> names;
  if (header.format.has_colour) names.emplace_back("colour");
  if (header.format.has_near_infrared) names.emplace_back("near infrared");
  if (header.format.has_wave) names.emplace_back("waveform");
  if (header.point_bytes > header.format.num_bytes) {
    names.push_back(NumberText(header.point_bytes - header.format.num_bytes) + " extra bytes");
  }
  return names;
}

Cloud CloudOfLas(const std::string& name, std::string_view bytes) {
  const Bytes file(bytes);
  const LasHeader header = ReadLasHeader(file);
  const StatedUnit unit = CheckRecords(file, header);
  Cloud cloud = EmptyCloud(header);
  cloud.data.reserve(header.num_points * cloud.point_step);
  std::uint64_t num_withheld = 0;
  for (std::uint64_t i = 0; i < header.num_points; ++i) {
    const Bytes point(file.Text(header.points_begin + i * header.point_bytes, header.point_bytes));
    if (!Append(point, header, cloud)) ++num_withheld;
  }
  CheckBounds(header, cloud);
  const std::uint64_t end = header.points_begin + header.num_points * header.point_bytes;
  const std::uint64_t rest = std::max(EndOfPoints(file, header), end) - end;
  const std::vector<std::string> left_out = FieldsLeftOut(header);
  cloud.remarks = {
      {.kind = RemarkKind::kPointsBeyondData, .place = name, .number = rest / header.point_bytes},
      {.kind = RemarkKind::kSurplusBytes, .place = name, .number = rest % header.point_bytes},
      {.kind = RemarkKind::kPointsWithheld, .place = name, .number = num_withheld},
      {.kind = RemarkKind::kUnitsAssumed,
       .place = name,
       .number = unit.is_metre && unit.codes.empty() ? 0U : 1U,
       .detail = unit.codes},
      {.kind = RemarkKind::kFieldsLeftOut,
       .place = name,
       .number = left_out.size(),
       .detail = Join(left_out)}};
  std::erase_if(cloud.remarks, [](const Remark& remark) { return remark.number == 0; });
  return cloud;
}

}  // namespace

bool IsLasFile(const std::filesystem::path& file) {
  return LowerCase(file.extension().string()) == ".las";
}

Cloud ParseLas(const std::string& file, std::string_view bytes) {
  return AtPlace(file + ": ", [&] { return CloudOfLas(file, bytes); });
}

Cloud ReadLas(const std::filesystem::path& file) {
  return ParseLas(ShownPath(file), ReadFileWhole(file));
}

}  // namespace railcast
