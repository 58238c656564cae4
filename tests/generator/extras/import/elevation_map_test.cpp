#include "generator/extras/import/heights/elevation_map.h"

#include <gdal_priv.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <ogr_spatialref.h>

#include <array>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "core/io/write_file.h"
#include "railcast/error.h"
#include "tests/core/io/temporary_directory.h"

namespace railcast {
namespace {

namespace fs = std::filesystem;
using ::testing::HasSubstr;

/// Metres as they are, 1000 m east and 2000 m north of the map's origin.
MapProjection InMetres() {
  return {.definition = "EPSG:31256", .origin_m = {1000.0, 340000.0}};
}

Eigen::AlignedBox2d Bounds(double from_m, double to_m) {
  return {Eigen::Vector2d(from_m, from_m), Eigen::Vector2d(to_m, to_m)};
}

/// Heights of a plane that rises by 3 % to the east and 1 % to the north.
double PlaneHeight_m(const Eigen::Vector2d& place_m) {
  return 200.0 + 0.03 * place_m.x() + 0.01 * place_m.y();
}

class Elevation : public ::testing::Test {
 protected:
  [[nodiscard]] fs::path Path(const std::string& name) const { return directory_.path() / name; }
  fs::path Write(const std::string& name, const std::string& text) {
    WriteFileWhole(Path(name), text);
    return Path(name);
  }
  /// The plane on cells of 10 m about the map's origin, in the coordinates of InMetres().
  static std::string PlaneGrid() {
    std::string text =
        "ncols 40\nnrows 40\nxllcorner 800\nyllcorner 339800\ncellsize 10\n"
        "NODATA_value -9999\n";
    for (int row = 0; row < 40; ++row) {
      for (int column = 0; column < 40; ++column) {
        const Eigen::Vector2d place_m(-195.0 + 10.0 * column, 195.0 - 10.0 * row);
        text += std::to_string(PlaneHeight_m(place_m)) + " ";
      }
      text += "\n";
    }
    return text;
  }
  std::string Fault(const fs::path& file, const std::string& crs) {
    try {
      const ElevationMap read(file, crs, InMetres(), Bounds(-100.0, 100.0));
    } catch (const InputError& error) {
      std::string message = error.what();
      const std::string folder = directory_.path().string() + "/";
      if (message.starts_with(folder)) message.erase(0, folder.size());
      return message;
    }
    return "no error";
  }

 private:
  TemporaryDirectory directory_;
};

TEST_F(Elevation, IsReadFromAnAsciiGrid) {
  const ElevationMap map(Write("dem.asc", PlaneGrid()), "EPSG:31256", InMetres(),
                         Bounds(-100.0, 100.0));
  EXPECT_NEAR(map.cell_m(), 10.0, 1e-6);
  const std::vector<Eigen::Vector2d> places_m = {{0.0, 0.0}, {-100.0, 37.0}, {99.0, -12.3}};
  const auto heights_m = map.HeightsAt(places_m);
  for (std::size_t i = 0; i < places_m.size(); ++i) {
    // Heights are read as float32: 2e-5 m at 200 m.
    EXPECT_NEAR(heights_m[i].value(), PlaneHeight_m(places_m[i]), 1e-4) << i;
  }
  EXPECT_TRUE(map.Covers({0.0, 0.0}));
  EXPECT_FALSE(map.Covers({5000.0, 0.0}));
}

/// GDAL alone takes twice as long for each row that is missing, and moves heights from row to row.
TEST_F(Elevation, OfAGridWithTooFewOrTooManyHeightsIsRefused) {
  const std::string grid = PlaneGrid();
  const std::string rule = "dem.asc: must have ncols x nrows heights, 1600 (got ";
  const std::size_t last_row = grid.rfind('\n', grid.size() - 2);
  EXPECT_EQ(Fault(Write("dem.asc", grid.substr(0, last_row)), "EPSG:31256"), rule + "1560)");
  EXPECT_EQ(Fault(Write("dem.asc", grid + "200\n"), "EPSG:31256"), rule + "1601)");
}

/// The same plane in degrees, as a GeoTIFF that knows its coordinate system.
TEST_F(Elevation, IsReadFromAGeoTiffInAnotherSystem) {
  GDALAllRegister();
  OGRSpatialReference metres;
  OGRSpatialReference degrees;
  metres.SetFromUserInput("EPSG:31256");
  degrees.SetFromUserInput("EPSG:4326");
  for (OGRSpatialReference* system : {&metres, &degrees}) {
    system->SetAxisMappingStrategy(OAMS_TRADITIONAL_GIS_ORDER);
  }
  const std::unique_ptr<OGRCoordinateTransformation> metres_from_degrees(
      OGRCreateCoordinateTransformation(&degrees, &metres));
  const std::unique_ptr<OGRCoordinateTransformation> degrees_from_metres(
      OGRCreateCoordinateTransformation(&metres, &degrees));
  double longitude_deg = 1000.0;
  double latitude_deg = 340000.0;
  ASSERT_TRUE(degrees_from_metres->Transform(1, &longitude_deg, &latitude_deg));

  constexpr int kSize = 80;
  constexpr double kCell_deg = 1e-4;
  const fs::path file = Path("dem.tif");
  {
    const std::unique_ptr<GDALDataset> dataset(
        GetGDALDriverManager()->GetDriverByName("GTiff")->Create(file.c_str(), kSize, kSize, 1,
                                                                 GDT_Float32, nullptr));
    std::array<double, 6> system_from_cell = {
        longitude_deg - 0.5 * kSize * kCell_deg, kCell_deg, 0.0,
        latitude_deg + 0.5 * kSize * kCell_deg,  0.0,       -kCell_deg};
    dataset->SetGeoTransform(system_from_cell.data());
    dataset->SetSpatialRef(&degrees);
    std::vector<float> row_m(kSize);
    for (int row = 0; row < kSize; ++row) {
      for (int column = 0; column < kSize; ++column) {
        double x = system_from_cell[0] + (column + 0.5) * kCell_deg;
        double y = system_from_cell[3] - (row + 0.5) * kCell_deg;
        ASSERT_TRUE(metres_from_degrees->Transform(1, &x, &y));
        row_m[static_cast<std::size_t>(column)] =
            static_cast<float>(PlaneHeight_m({x - 1000.0, y - 340000.0}));
      }
      ASSERT_EQ(dataset->GetRasterBand(1)->RasterIO(GF_Write, 0, row, kSize, 1, row_m.data(), kSize,
                                                    1, GDT_Float32, 0, 0, nullptr),
                CE_None);
    }
  }
  const ElevationMap map(file, "", InMetres(), Bounds(-100.0, 100.0));
  // 1e-4 degrees of latitude are 11.1 m, of longitude 7.4 m.
  EXPECT_NEAR(map.cell_m(), 11.1, 0.1);
  EXPECT_NEAR(map.HeightsAt({{40.0, -60.0}}).front().value(), PlaneHeight_m({40.0, -60.0}), 1e-3);
}

/// The middle of its first cell, which is 483 m high and the north-western one.
TEST_F(Elevation, IsReadFromARealModelInDegrees) {
  const fs::path file = RAILCAST_SHARED_DATA_DIR "/dem_jacksboro/jacksboro_fault_dem.asc";
  if (!fs::exists(file)) GTEST_SKIP() << file << " is absent";
  constexpr double kCell_deg = 0.000833333333;
  RailMap map;
  map.nodes.push_back(
      {.geographic_deg = {-84.41375 + 0.5 * kCell_deg, 36.44625 + 343.5 * kCell_deg}, .tags = {}});
  map.nodes.push_back({.geographic_deg = {-84.40, 36.72}, .tags = {}});
  const MapProjection projection = ProjectMap("", map);
  Eigen::AlignedBox2d bounds_m;
  for (const MapNode& node : map.nodes) bounds_m.extend(node.place_m);
  const ElevationMap read(file, "EPSG:4326", projection, bounds_m);
  // A little inside, since the outermost cells' middles are where it ends.
  const Eigen::Vector2d place_m = map.nodes[0].place_m + Eigen::Vector2d(0.01, -0.01);
  EXPECT_NEAR(read.HeightsAt({place_m}).front().value(), 483.0, 0.01);
  EXPECT_NEAR(read.cell_m(), 92.5, 0.5);
}

TEST_F(Elevation, HasNoHeightsBesideGaps) {
  const std::string head =
      "ncols 4\nnrows 2\nxllcorner 980\nyllcorner 339990\ncellsize 10\n"
      "NODATA_value -9999\n";
  const ElevationMap map(Write("dem.asc", head + "1 2 3 -9999\n1 2 3 4\n"), "EPSG:31256",
                         InMetres(), Bounds(-20.0, 20.0));
  const auto heights_m = map.HeightsAt({{-10.0, 0.0}, {10.0, 0.0}, {10.0, -5.0}});
  EXPECT_NEAR(heights_m[0].value(), 1.5, 1e-6);
  EXPECT_FALSE(heights_m[1]);
  EXPECT_NEAR(heights_m[2].value(), 3.5, 1e-6) << "the cells above it do not count";
}

TEST_F(Elevation, IsWrittenAsTheGridOfAWorld) {
  const ElevationMap map(Write("dem.asc", PlaneGrid()), "EPSG:31256", InMetres(),
                         Bounds(-100.0, 100.0));
  const std::string text = ElevationGridText(map, Bounds(-42.0, 33.0));
  EXPECT_THAT(text, HasSubstr("ncols 9\nnrows 9\nxllcorner -50\nyllcorner -50\ncellsize 10\n"));
  // Coordinates of the world are those of the map's metres: what is written reads the same.
  const MapProjection world{.definition = "EPSG:31256", .origin_m = {0.0, 0.0}};
  const ElevationMap again(Write("world.asc", text), "EPSG:31256", world, Bounds(-30.0, 30.0));
  // Heights are written to 0.01 m.
  EXPECT_NEAR(again.HeightsAt({{12.0, -7.0}}).front().value(), PlaneHeight_m({12.0, -7.0}), 0.006);
}

TEST_F(Elevation, IsRefusedInOneLineWhereItIsWrong) {
  EXPECT_EQ(Fault(Path("none.asc"), ""), "none.asc: no such file or directory");
  EXPECT_THAT(Fault(Write("text.asc", "hello"), "EPSG:31256"),
              HasSubstr("text.asc: must be a raster of heights, such as GeoTIFF or an ESRI ASCII "
                        "grid"));
  EXPECT_EQ(Fault(Write("dem.asc", PlaneGrid()), ""),
            "dem.asc: must have a coordinate system; name it with --heights-crs, such as EPSG:4326 "
            "(got none)");
  EXPECT_EQ(Fault(Path("dem.asc"), "EPSG:99999"),
            "--heights-crs: must be a coordinate system that PROJ knows, such as EPSG:4326 (got "
            "EPSG:99999)");
  for (const auto& [crs, got] : std::vector<std::pair<std::string, std::string>>{
           {"EPSG:4326+6360", "metres (got US survey foot)"},
           {"EPSG:31256+8228", "metres (got foot)"},
           {"EPSG:4326+5715", "heights (got depths)"}}) {
    EXPECT_THAT(Fault(Path("dem.asc"), crs), testing::StartsWith("--heights-crs: must have "))
        << crs;
    EXPECT_THAT(Fault(Path("dem.asc"), crs), HasSubstr(got)) << crs;
  }
  EXPECT_THAT(Fault(Path("dem.asc"), "EPSG:31256+5778"),
              testing::Not(testing::StartsWith("--heights-crs")));
  const std::string grid = PlaneGrid();
  const std::string cut = Fault(Write("cut.asc", grid.substr(0, grid.size() / 2)), "EPSG:31256");
  EXPECT_THAT(cut, HasSubstr("cut.asc: must have ncols x nrows heights, 1600 (got "));
  EXPECT_EQ(cut.find('\n'), std::string::npos) << cut;
}

TEST_F(Elevation, MustBeInMetresAndOneBand) {
  GDALAllRegister();
  for (const bool is_in_feet : {true, false}) {
    const fs::path file = Path(is_in_feet ? "feet.tif" : "rgb.tif");
    {
      const std::unique_ptr<GDALDataset> dataset(
          GetGDALDriverManager()->GetDriverByName("GTiff")->Create(
              file.c_str(), 4, 4, is_in_feet ? 1 : 3, GDT_Float32, nullptr));
      if (is_in_feet) dataset->GetRasterBand(1)->SetUnitType("ft");
    }
    EXPECT_EQ(Fault(file, "EPSG:31256"), is_in_feet
                                             ? "feet.tif: must have heights in metres (got ft)"
                                             : "rgb.tif: must have one band, of heights (got 3)");
  }
}

}  // namespace
}  // namespace railcast
