#include "generator/extras/import/heights/elevation_map.h"

#include <gdal_priv.h>
#include <ogr_spatialref.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>
#include <cstdint>
#include <limits>
#include <map>
#include <sstream>
#include <string_view>

#include "core/base/error.h"
#include "core/base/input_file.h"
#include "core/base/text.h"
#include "core/base/text_encoding.h"
#include "core/base/text_number.h"
#include "generator/extras/import/map/gdal_errors.h"
#include "generator/extras/import/map/rail_map.h"

namespace railcast {
namespace {

/// Cells of the part that is read.
constexpr std::int64_t kMostCells = 200'000'000;
constexpr int kMargin_cells = 2;

OGRSpatialReference SystemOf(const std::string& definition) {
  OGRSpatialReference system;
  if (definition.empty() || system.SetFromUserInput(definition.c_str()) != OGRERR_NONE) {
    throw InputError(
        "--heights-crs: must be a coordinate system that PROJ knows, such as "
        "EPSG:4326 (got " +
        ShownText(definition) + ")");
  }
  system.SetAxisMappingStrategy(OAMS_TRADITIONAL_GIS_ORDER);
  return system;
}

/// Checks that the heights of a system, if it has any, are metres above something.
void CheckHeightsOf(const OGRSpatialReference& system, const std::string& place) {
  const char* unit = nullptr;
  const double unit_m = system.IsVertical() != 0 || system.IsCompound() != 0
                            ? system.GetTargetLinearUnits("VERT_CS", &unit)
                            : 1.0;
  constexpr double kRounding = 1e-9;
  if (std::abs(unit_m - 1.0) > kRounding) {
    throw InputError(place + ": must have heights in metres (got " +
                     ShownText(unit == nullptr ? "another unit" : unit) + ")");
  }
  OGRAxisOrientation direction = OAO_Up;
  (void)system.GetAxis("VERT_CS", 0, &direction);
  if (direction == OAO_Down) throw InputError(place + ": must have heights (got depths)");
}

using Transformation = std::unique_ptr<OGRCoordinateTransformation>;

/// The columns and rows of a raster, from its geotransform.
struct GridPlaces {
  std::array<double, 6> system_from_cell{};
  std::array<double, 6> cell_from_system{};

  /// Column and row; the first cell's middle is 0.5, 0.5.
  [[nodiscard]] Eigen::Vector2d CellOf(double x, double y) const {
    const auto& t = cell_from_system;
    return {t[0] + t[1] * x + t[2] * y, t[3] + t[4] * x + t[5] * y};
  }
};

GridPlaces PlacesOf(GDALDataset& dataset, const std::string& name) {
  GridPlaces places;
  if (dataset.GetGeoTransform(places.system_from_cell.data()) != CE_None ||
      GDALInvGeoTransform(places.system_from_cell.data(), places.cell_from_system.data()) == 0) {
    throw InputError(name + ": must say where its cells are (a geotransform)");
  }
  return places;
}

Transformation TransformationFrom(const MapProjection& projection,
                                  GDALDataset& dataset,
                                  const std::string& crs,
                                  const std::string& name) {
  OGRSpatialReference from = SystemOf(projection.definition);
  OGRSpatialReference to;
  if (const OGRSpatialReference* own = dataset.GetSpatialRef(); own != nullptr) {
    to = *own;
    to.SetAxisMappingStrategy(OAMS_TRADITIONAL_GIS_ORDER);
    CheckHeightsOf(to, name);
    if (!crs.empty()) CheckHeightsOf(SystemOf(crs), "--heights-crs");
    if (!crs.empty() && SystemOf(crs).IsSame(&to) == 0) {
      throw InputError("--heights-crs: must be left out, for " + name + " states its own (got " +
                       ShownText(crs) + ")");
    }
  } else if (crs.empty()) {
    throw InputError(name +
                     ": must have a coordinate system; name it with --heights-crs, such as "
                     "EPSG:4326 (got none)");
  } else {
    to = SystemOf(crs);
    CheckHeightsOf(to, "--heights-crs");
  }
  Transformation transformation(OGRCreateCoordinateTransformation(&from, &to));
  if (!transformation) {
    throw InputError(name + ": must have a coordinate system that the map's can be changed to");
  }
  return transformation;
}

/// The one band of heights.
GDALRasterBand& BandOf(GDALDataset& dataset, const std::string& name) {
  if (dataset.GetRasterCount() != 1) {
    throw InputError(name + ": must have one band, of heights" + Got(dataset.GetRasterCount()));
  }
  GDALRasterBand& band = *dataset.GetRasterBand(1);
  const std::string unit = band.GetUnitType();
  if (!unit.empty() && unit != "m" && unit != "metre" && unit != "meter" && unit != "metres" &&
      unit != "meters") {
    throw InputError(name + ": must have heights in metres (got " + ShownText(unit) + ")");
  }
  return band;
}

/// Checks the text of an ESRI ASCII grid: GDAL takes words that are no numbers for 0, passes over
/// numbers too many, and looks for those that are missing for 2^n steps, n rows behind the end.
void CheckAsciiGrid(const std::string& name, std::string_view text) {
  std::map<std::string, double, std::less<>> head;
  std::size_t num_heights = 0;
  for (std::size_t number = 1; const auto line = TakeLine(text); ++number) {
    const auto words = Words(*line);
    const bool is_head = num_heights == 0 && words.size() == 2 && std::isalpha(words[0][0]) != 0 &&
                         LowerCase(words[0]) != "nan";
    const bool may_be_nan =
        is_head || (head.contains("nodata_value") && std::isnan(head["nodata_value"]));
    std::string word;
    for (std::size_t i = is_head ? 1 : 0; i < words.size(); ++i) {
      word = words[i];
      std::ranges::replace(word, ',', '.');  // As GDAL reads them.
      const auto value = ParseTextNumber<double>(word);
      if (!value || !(std::isfinite(*value) || may_be_nan)) {
        throw InputError(name + ": line " + std::to_string(number) + ": must be numbers (got " +
                         ShownText(words[i]) + ")");
      }
      if (is_head) head[LowerCase(words[0])] = *value;
    }
    if (!is_head) num_heights += words.size();
  }
  const double num_cells = head["ncols"] * head["nrows"];
  if (static_cast<double>(num_heights) != num_cells) {
    throw InputError(name + ": must have ncols x nrows heights, " + NumberText(num_cells) +
                     Got(num_heights));
  }
  const auto has_any = [&](const char* corner, const char* centre) {
    if (head.contains(corner) || head.contains(centre)) return;
    throw InputError(name + ": must have " + corner + " or " + centre + " (got neither)");
  };
  has_any("xllcorner", "xllcenter");
  has_any("yllcorner", "yllcenter");
  const bool has_size = head["cellsize"] > 0.0 || (head["dx"] > 0.0 && head["dy"] > 0.0);
  if (!has_size) throw InputError(name + ": cellsize: must be > 0" + Got(head["cellsize"]));
}

}  // namespace

struct ElevationMap::Raster {
  Transformation system_from_map;
  Eigen::Vector2d origin_m;
  GridPlaces places;
  // The part that was read.
  int first_column{};
  int first_row{};
  int num_columns{};
  int num_rows{};
  std::vector<float> heights_m;  ///< NaN where there is none.
  std::size_t num_void = 0;
  double first_void_m = 0.0;

  /// Column and row in the part of the middle of a cell: whole numbers.
  [[nodiscard]] std::vector<Eigen::Vector2d> CellsOf(
      const std::vector<Eigen::Vector2d>& places_m) const {
    std::vector<double> x;
    std::vector<double> y;
    for (const Eigen::Vector2d& place_m : places_m) {
      x.push_back(place_m.x() + origin_m.x());
      y.push_back(place_m.y() + origin_m.y());
    }
    std::vector<int> is_valid(places_m.size());
    system_from_map->Transform(static_cast<int>(x.size()), x.data(), y.data(), nullptr,
                               is_valid.data());
    std::vector<Eigen::Vector2d> cells;
    for (std::size_t i = 0; i < x.size(); ++i) {
      constexpr double kNowhere = std::numeric_limits<double>::quiet_NaN();
      cells.push_back(is_valid[i] == 0
                          ? Eigen::Vector2d(kNowhere, kNowhere)
                          : Eigen::Vector2d(places.CellOf(x[i], y[i]) -
                                            Eigen::Vector2d(first_column + 0.5, first_row + 0.5)));
    }
    return cells;
  }

  [[nodiscard]] bool Has(const Eigen::Vector2d& cell) const {
    return cell.x() >= 0.0 && cell.x() <= num_columns - 1 && cell.y() >= 0.0 &&
           cell.y() <= num_rows - 1;
  }

  [[nodiscard]] std::optional<double> HeightAt(const Eigen::Vector2d& cell) const {
    if (!Has(cell)) return std::nullopt;
    const int column = std::min(static_cast<int>(cell.x()), std::max(0, num_columns - 2));
    const int row = std::min(static_cast<int>(cell.y()), std::max(0, num_rows - 2));
    const Eigen::Vector2d share(cell.x() - column, cell.y() - row);
    double height_m = 0.0;
    for (const int down : {0, 1}) {
      for (const int right : {0, 1}) {
        const double weight =
            (right == 1 ? share.x() : 1.0 - share.x()) * (down == 1 ? share.y() : 1.0 - share.y());
        if (weight == 0.0) continue;
        const std::size_t cell_index =
            static_cast<std::size_t>(row + down) * static_cast<std::size_t>(num_columns) +
            static_cast<std::size_t>(column + right);
        height_m += weight * static_cast<double>(heights_m[cell_index]);
      }
    }
    if (std::isnan(height_m)) return std::nullopt;
    return height_m;
  }

  /// Sets the part to the cells about the bounds.
  void Choose(const Eigen::AlignedBox2d& bounds_m, const Eigen::Vector2i& size_cells);
  void Read(GDALRasterBand& band);
};

void ElevationMap::Raster::Choose(const Eigen::AlignedBox2d& bounds_m,
                                  const Eigen::Vector2i& size_cells) {
  constexpr int kNumSteps = 20;
  std::vector<Eigen::Vector2d> edge_m;
  for (int i = 0; i <= kNumSteps; ++i) {
    const Eigen::Vector2d at_m =
        bounds_m.min() + bounds_m.sizes() * (static_cast<double>(i) / kNumSteps);
    edge_m.emplace_back(at_m.x(), bounds_m.min().y());
    edge_m.emplace_back(at_m.x(), bounds_m.max().y());
    edge_m.emplace_back(bounds_m.min().x(), at_m.y());
    edge_m.emplace_back(bounds_m.max().x(), at_m.y());
  }
  Eigen::AlignedBox2d cells;
  for (const Eigen::Vector2d& cell : CellsOf(edge_m)) {
    if (cell.allFinite()) cells.extend(cell);
  }
  if (cells.isEmpty()) return;
  const Eigen::Vector2d most = size_cells.cast<double>();
  const auto limited = [&](const Eigen::Vector2d& cell) -> Eigen::Vector2i {
    return cell.cwiseMax(0.0).cwiseMin(most).cast<int>();
  };
  const Eigen::Vector2i first = limited(cells.min().array().floor() - kMargin_cells);
  const Eigen::Vector2i end = limited(cells.max().array().ceil() + kMargin_cells + 1);
  first_column = first.x();
  first_row = first.y();
  num_columns = end.x() - first.x();
  num_rows = end.y() - first.y();
}

void ElevationMap::Raster::Read(GDALRasterBand& band) {
  heights_m.resize(static_cast<std::size_t>(num_columns) * static_cast<std::size_t>(num_rows));
  if (heights_m.empty()) return;
  if (band.RasterIO(GF_Read, first_column, first_row, num_columns, num_rows, heights_m.data(),
                    num_columns, num_rows, GDT_Float32, 0, 0, nullptr) != CE_None) {
    return;  // The handler has the error.
  }
  int has_nothing = 0;
  const auto nothing = static_cast<float>(band.GetNoDataValue(&has_nothing));
  const auto scale = static_cast<float>(band.GetScale());
  const auto offset = static_cast<float>(band.GetOffset());
  for (float& height_m : heights_m) {
    if ((has_nothing != 0 && height_m == nothing) || !std::isfinite(height_m)) {
      height_m = std::numeric_limits<float>::quiet_NaN();
      continue;
    }
    height_m = offset + scale * height_m;
    if (IsHeight(double{height_m})) continue;
    if (num_void++ == 0) first_void_m = double{height_m};
    height_m = std::numeric_limits<float>::quiet_NaN();
  }
}

ElevationMap::ElevationMap(const std::filesystem::path& file,
                           const std::string& crs,
                           const MapProjection& projection,
                           const Eigen::AlignedBox2d& bounds_m)
    : name_(ShownPath(file)) {
  CheckIsReadable(file);
  GDALAllRegister();
  GdalErrors gdal_errors;
  const std::unique_ptr<GDALDataset> dataset(
      GDALDataset::Open(file.c_str(), GDAL_OF_RASTER | GDAL_OF_READONLY));
  if (!dataset) {
    const std::string& reason = gdal_errors.first();
    throw InputError(name_ +
                     ": must be a raster of heights, such as GeoTIFF or an ESRI ASCII grid" +
                     (reason.empty() ? "" : " (" + ShownText(reason) + ")"));
  }
  gdal_errors.Forget();
  if (std::string_view(dataset->GetDriverName()) == "AAIGrid") {
    CheckAsciiGrid(name_, ReadTextWhole(file));
  }
  GDALRasterBand& band = BandOf(*dataset, name_);
  auto raster = std::make_unique<Raster>();
  raster->places = PlacesOf(*dataset, name_);
  raster->system_from_map = TransformationFrom(projection, *dataset, crs, name_);
  raster->origin_m = projection.origin_m;
  raster->Choose(bounds_m, {band.GetXSize(), band.GetYSize()});
  if (std::int64_t{raster->num_columns} * raster->num_rows > kMostCells) {
    throw InputError(name_ + ": must have at most " + std::to_string(kMostCells) +
                     " cells about the lines" +
                     Got(std::int64_t{raster->num_columns} * raster->num_rows));
  }
  raster->Read(band);
  if (!gdal_errors.first().empty()) {
    throw InputError(name_ + ": must be readable to its end (" + ShownText(gdal_errors.first()) +
                     ")");
  }
  // How far a step of 1 m leads in cells.
  const Eigen::Vector2d middle_m = bounds_m.center();
  const std::vector<Eigen::Vector2d> steps = raster->CellsOf(
      {middle_m, middle_m + Eigen::Vector2d(1.0, 0.0), middle_m + Eigen::Vector2d(0.0, 1.0)});
  cell_m_ = std::max(1.0 / (steps[1] - steps[0]).norm(), 1.0 / (steps[2] - steps[0]).norm());
  if (!std::isfinite(cell_m_)) {
    throw InputError(name_ + ": must be in a coordinate system that covers the map");
  }
  raster_ = std::move(raster);
}

ElevationMap::~ElevationMap() = default;

std::vector<std::optional<double>> ElevationMap::HeightsAt(
    const std::vector<Eigen::Vector2d>& places_m) const {
  std::vector<std::optional<double>> heights_m;
  for (const Eigen::Vector2d& cell : raster_->CellsOf(places_m)) {
    heights_m.push_back(raster_->HeightAt(cell));
  }
  return heights_m;
}

std::size_t ElevationMap::num_void() const {
  return raster_->num_void;
}

double ElevationMap::first_void_m() const {
  return raster_->first_void_m;
}

bool ElevationMap::Covers(const Eigen::Vector2d& place_m) const {
  return raster_->Has(raster_->CellsOf({place_m}).front());
}

std::string ElevationGridText(const ElevationMap& elevation, const Eigen::AlignedBox2d& bounds_m) {
  constexpr double kMostGridCells = 1e6;
  constexpr int kNothing = -9999;
  constexpr double kRounding_m = 1e-3;  // For a cell that is whole metres, but for its projection.
  const double cell_m =
      std::ceil(std::max({1.0, elevation.cell_m(), std::sqrt(bounds_m.volume() / kMostGridCells)}) -
                kRounding_m);
  const Eigen::Vector2d corner_m = (bounds_m.min() / cell_m).array().floor() * cell_m;
  const Eigen::Vector2i num_cells =
      ((bounds_m.max() - corner_m) / cell_m).array().ceil().max(1.0).cast<int>();
  std::ostringstream head;
  head << "ncols " << num_cells.x() << "\nnrows " << num_cells.y() << "\nxllcorner "
       << NumberText(corner_m.x()) << "\nyllcorner " << NumberText(corner_m.y()) << "\ncellsize "
       << NumberText(cell_m) << "\nNODATA_value " << kNothing << '\n';
  std::string text = head.str();
  std::vector<Eigen::Vector2d> places_m(static_cast<std::size_t>(num_cells.x()));
  for (int row = num_cells.y(); row-- > 0;) {
    for (int column = 0; column < num_cells.x(); ++column) {
      places_m[static_cast<std::size_t>(column)] =
          corner_m + cell_m * Eigen::Vector2d(column + 0.5, row + 0.5);
    }
    const char* separator = "";
    for (const std::optional<double>& height_m : elevation.HeightsAt(places_m)) {
      constexpr double kSteps_per_m = 100.0;
      text += separator;
      text += NumberText(height_m ? std::round(*height_m * kSteps_per_m) / kSteps_per_m : kNothing);
      separator = " ";
    }
    text += '\n';
  }
  return text;
}

}  // namespace railcast
