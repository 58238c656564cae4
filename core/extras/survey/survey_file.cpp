#include "core/extras/survey/survey_file.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>
#include <string_view>
#include <utility>

#include "core/base/error.h"
#include "core/base/input_file.h"
#include "core/base/inputs.h"
#include "core/base/out_of_memory.h"
#include "core/base/text.h"

namespace railcast {
namespace {

static_assert(std::endian::native == std::endian::little, "files are little-endian");

constexpr double kLeastReflectivity = 0.01;
constexpr double kLevelRatio = 1.1;
constexpr std::string_view kSurveyMagic = "RAILCAST SURVEY1";
constexpr std::size_t kSurfelBytes = 9 * sizeof(float) + 4;
constexpr std::size_t kGroundBytes = kGroundCells * kGroundCells * sizeof(float);
constexpr std::size_t kTileBytes = 2 * 4 + 8 + 2 * 4 + 2 * 8 + kGroundBytes;
constexpr std::size_t kMostLabelBytes = 1000;
/// Beyond this nothing is in a tile, not even the top of a wire's pole on the next tile.
constexpr float kMostFromTile_m = 1e4F;

template <class T>
void PutValue(const T& value, std::string& bytes) {
  std::array<char, sizeof(T)> raw{};
  std::memcpy(raw.data(), &value, sizeof(T));
  bytes.append(raw.data(), raw.size());
}

void PutSurface(const SurveySurface& surface, std::string& bytes) {
  PutValue(surface.level, bytes);
  PutValue(std::uint8_t{0}, bytes);
  PutValue(surface.label, bytes);
}

void PutVector(const Eigen::Vector3f& vector, std::string& bytes) {
  for (const float value : vector) PutValue(value, bytes);
}

/// Takes values off the beginning of bytes that came from a file.
class SurveyBytes {
 public:
  SurveyBytes(std::string_view bytes, const std::filesystem::path& file)
      : bytes_(bytes), file_(file) {}

  [[noreturn]] void Fail(const std::string& fault) const {
    throw InputError({Fault{ShownPath(file_.filename()), fault, ""}});
  }
  [[nodiscard]] std::string_view Take(std::size_t num_bytes) {
    if (num_bytes > bytes_.size()) Fail("is damaged: it ends too early");
    const std::string_view taken = bytes_.substr(0, num_bytes);
    bytes_.remove_prefix(num_bytes);
    return taken;
  }
  template <class T>
  [[nodiscard]] T Take() {
    T value{};
    const std::string_view taken = Take(sizeof(T));
    std::memcpy(&value, taken.data(), taken.size());
    return value;
  }
  [[nodiscard]] Eigen::Vector3f TakeVector() {
    Eigen::Vector3f vector;
    for (float& value : vector) {
      value = Take<float>();
      if (!(std::abs(value) <= kMostFromTile_m)) Fail("is damaged: a point is nowhere");
    }
    return vector;
  }
  [[nodiscard]] SurveySurface TakeSurface(std::size_t num_labels) {
    SurveySurface surface{.level = Take<std::uint8_t>()};
    static_cast<void>(Take<std::uint8_t>());
    surface.label = Take<std::uint16_t>();
    if (surface.level >= kNumSurveyLevels || surface.label >= num_labels) {
      Fail("is damaged: a surface has an unknown label or reflectivity");
    }
    return surface;
  }
  [[nodiscard]] std::size_t size() const { return bytes_.size(); }

 private:
  std::string_view bytes_;
  const std::filesystem::path& file_;
};

std::string BytesAt(const std::filesystem::path& file,
                    std::uint64_t offset,
                    std::size_t num_bytes) {
  std::ifstream stream = OpenInput(file);
  std::string bytes(num_bytes, '\0');
  stream.seekg(static_cast<std::streamoff>(offset));
  stream.read(bytes.data(), static_cast<std::streamsize>(num_bytes));
  if (!stream)
    throw InputError({Fault{ShownPath(file.filename()), "is damaged: it ends too early", ""}});
  return bytes;
}

std::string TileBytes(const SurveyTile& tile) {
  std::string bytes;
  bytes.reserve(kSurfelBytes * tile.surfels.size());
  for (const Surfel& surfel : tile.surfels) {
    PutVector(surfel.center_m, bytes);
    PutVector(surfel.half_u_m, bytes);
    PutVector(surfel.half_v_m, bytes);
    PutSurface(surfel.surface, bytes);
  }
  for (const SurveyedWire& wire : tile.wires) {
    PutSurface(wire.surface, bytes);
    PutValue(wire.radius_m, bytes);
    PutValue(static_cast<std::uint32_t>(wire.points_m.size()), bytes);
    for (const Eigen::Vector3f& point_m : wire.points_m) PutVector(point_m, bytes);
  }
  return bytes;
}

SurveyedWire TakeWire(SurveyBytes& bytes, std::size_t num_labels) {
  SurveyedWire wire{
      .surface = bytes.TakeSurface(num_labels), .radius_m = bytes.Take<float>(), .points_m = {}};
  const auto num_points = bytes.Take<std::uint32_t>();
  constexpr float kMostRadius_m = 0.1F;
  if (!(wire.radius_m > 0.0F && wire.radius_m <= kMostRadius_m) || num_points < 2 ||
      num_points > bytes.size() / sizeof(Eigen::Vector3f)) {
    bytes.Fail("is damaged: a wire is none");
  }
  for (std::uint32_t i = 0; i < num_points; ++i) wire.points_m.push_back(bytes.TakeVector());
  const auto same = [](const Eigen::Vector3f& a, const Eigen::Vector3f& b) {
    return (a - b).norm() < 1e-3F;
  };
  if (std::ranges::adjacent_find(wire.points_m, same) != wire.points_m.end()) {
    bytes.Fail("is damaged: a wire is none");
  }
  return wire;
}

}  // namespace

std::uint8_t SurveyLevelOf(double reflectivity) {
  if (!(reflectivity > kLeastReflectivity)) return 0;
  const double level = std::log(reflectivity / kLeastReflectivity) / std::log(kLevelRatio);
  return static_cast<std::uint8_t>(std::min(std::round(level), kNumSurveyLevels - 1.0));
}

Material MaterialOfLevel(std::uint8_t level) {
  const std::string number = std::to_string(level);
  return {.name = "surveyed_" + std::string(2 - number.size(), '0') + number,
          .reflectivity = kLeastReflectivity * std::pow(kLevelRatio, level)};
}

std::array<std::int32_t, 2> SurveyCellAt(const Eigen::Vector2d& place_m) {
  return {static_cast<std::int32_t>(std::floor(place_m.x() / kSurveyTile_m)),
          static_cast<std::int32_t>(std::floor(place_m.y() / kSurveyTile_m))};
}

std::optional<double> GroundHeight_m(const SurveyTile& tile, const Eigen::Vector2d& place_m) {
  const Eigen::Vector2d cell =
      (place_m - tile.Origin_m().head<2>()) * (double{kGroundCells} / kSurveyTile_m);
  const auto index_of = [](double coordinate) {
    return static_cast<std::size_t>(std::clamp(coordinate, 0.0, kGroundCells - 1.0));
  };
  const float height_m = tile.ground_m[index_of(cell.y()) * kGroundCells + index_of(cell.x())];
  if (std::isnan(height_m)) return std::nullopt;
  return tile.base_m + double{height_m};
}

SurveyFile::SurveyFile(std::filesystem::path file) : file_(std::move(file)) {
  WithinMemory([&] { return ReadingText(file_); },
               [&] {
                 CheckIsReadable(file_);
                 NoteInput(file_);
                 const std::uint64_t size = std::filesystem::file_size(file_);
                 constexpr std::size_t kHead = kSurveyMagic.size() + std::size_t{3} * 4;
                 const std::string head = BytesAt(file_, 0, std::min<std::uint64_t>(size, kHead));
                 SurveyBytes counts(head, file_);
                 if (!head.starts_with(kSurveyMagic)) {
                   counts.Fail("must be a survey that railcast-generate survey has written");
                 }
                 static_cast<void>(counts.Take(kSurveyMagic.size()));
                 const auto num_labels = counts.Take<std::uint32_t>();
                 const auto label_bytes = counts.Take<std::uint32_t>();
                 const auto num_tiles = counts.Take<std::uint32_t>();
                 if (label_bytes > size || num_tiles > size / kTileBytes) {
                   counts.Fail("is damaged: it ends too early");
                 }
                 const std::string index =
                     BytesAt(file_, kHead, label_bytes + num_tiles * kTileBytes);
                 SurveyBytes bytes(index, file_);
                 for (std::uint32_t i = 0; i < num_labels; ++i) {
                   const auto length = bytes.Take<std::uint32_t>();
                   if (length > kMostLabelBytes) bytes.Fail("is damaged: a label is too long");
                   labels_.emplace_back(bytes.Take(length));
                 }
                 if (bytes.size() != num_tiles * kTileBytes)
                   bytes.Fail("is damaged: its labels have no end");
                 for (std::uint32_t i = 0; i < num_tiles; ++i) {
                   SurveyTile& tile = tiles_.emplace_back();
                   Place& place = places_.emplace_back();
                   for (std::int32_t& coordinate : tile.cell)
                     coordinate = bytes.Take<std::int32_t>();
                   tile.base_m = bytes.Take<double>();
                   place.num_surfels = bytes.Take<std::uint32_t>();
                   place.num_wires = bytes.Take<std::uint32_t>();
                   place.offset = bytes.Take<std::uint64_t>();
                   place.num_bytes = bytes.Take<std::uint64_t>();
                   tile.ground_m.resize(kGroundCells * kGroundCells);
                   constexpr double kMost_m = 1e8;
                   for (float& height_m : tile.ground_m) {
                     height_m = bytes.Take<float>();
                     if (std::abs(double{height_m}) > kMost_m)
                       bytes.Fail("is damaged: ground is nowhere");
                   }
                   const bool is_somewhere = std::abs(tile.cell[0] * kSurveyTile_m) <= kMost_m &&
                                             std::abs(tile.cell[1] * kSurveyTile_m) <= kMost_m &&
                                             std::abs(tile.base_m) <= kMost_m;
                   if (!is_somewhere) bytes.Fail("is damaged: a tile is nowhere");
                   if (place.offset > size || place.num_bytes > size - place.offset ||
                       place.num_surfels > place.num_bytes / kSurfelBytes) {
                     bytes.Fail("is damaged: it ends too early");
                   }
                 }
               });
}

std::size_t SurveyFile::num_surfels() const {
  std::size_t num = 0;
  for (const Place& place : places_) num += place.num_surfels;
  return num;
}

SurveyTile SurveyFile::Read(std::size_t tile) const {
  const Place& place = places_.at(tile);
  SurveyTile read = tiles_.at(tile);
  WithinMemory([&] { return ReadingText(file_); },
               [&] {
                 const std::string raw = BytesAt(file_, place.offset, place.num_bytes);
                 SurveyBytes bytes(raw, file_);
                 read.surfels.resize(place.num_surfels);
                 for (Surfel& surfel : read.surfels) {
                   surfel.center_m = bytes.TakeVector();
                   surfel.half_u_m = bytes.TakeVector();
                   surfel.half_v_m = bytes.TakeVector();
                   surfel.surface = bytes.TakeSurface(labels_.size());
                 }
                 for (std::uint32_t i = 0; i < place.num_wires; ++i) {
                   read.wires.push_back(TakeWire(bytes, labels_.size()));
                 }
               });
  return read;
}

std::string EncodeSurvey(const std::vector<std::string>& labels,
                         const std::vector<SurveyTile>& tiles) {
  std::string names;
  for (const std::string& label : labels) {
    PutValue(static_cast<std::uint32_t>(label.size()), names);
    names += label;
  }
  std::string bytes(kSurveyMagic);
  PutValue(static_cast<std::uint32_t>(labels.size()), bytes);
  PutValue(static_cast<std::uint32_t>(names.size()), bytes);
  PutValue(static_cast<std::uint32_t>(tiles.size()), bytes);
  bytes += names;
  std::uint64_t offset = bytes.size() + tiles.size() * kTileBytes;
  std::string contents;
  for (const SurveyTile& tile : tiles) {
    const std::string content = TileBytes(tile);
    for (const std::int32_t coordinate : tile.cell) PutValue(coordinate, bytes);
    PutValue(tile.base_m, bytes);
    PutValue(static_cast<std::uint32_t>(tile.surfels.size()), bytes);
    PutValue(static_cast<std::uint32_t>(tile.wires.size()), bytes);
    PutValue(offset, bytes);
    PutValue(std::uint64_t{content.size()}, bytes);
    Check(tile.ground_m.size() == kGroundCells * kGroundCells, "a tile has heights of its ground");
    for (const float height_m : tile.ground_m) PutValue(height_m, bytes);
    offset += content.size();
    contents += content;
  }
  return bytes + contents;
}

}  // namespace railcast
