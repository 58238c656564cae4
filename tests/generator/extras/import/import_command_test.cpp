#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <map>
#include <nlohmann/json.hpp>
#include <string>

#include "core/base/text.h"
#include "core/io/write_file.h"
#include "tests/core/io/temporary_directory.h"
#include "tests/generator/run_command.h"

namespace railcast {
namespace {

namespace fs = std::filesystem;
using ::testing::HasSubstr;

constexpr const char* kMap = R"({"type": "FeatureCollection", "features": [
  {"type": "Feature", "properties": {"railway": "rail", "name": "Hill Line", "maxspeed": "60"},
   "geometry": {"type": "LineString", "coordinates":
    [[15.60, 48.20], [15.61, 48.20], [15.62, 48.2003], [15.63, 48.201]]}}]})";

TEST(Import, WritesAnAlignmentAndTheReports) {
  const TemporaryDirectory directory;
  const fs::path map = directory.path() / "map.geojson";
  const fs::path out = directory.path() / "out";
  WriteFileWhole(map, kMap);
  const Ended run = Generate("import " + map.string() + " --out " + out.string());
  ASSERT_EQ(run.status, 0) << run.said;
  EXPECT_THAT(run.said, HasSubstr("projection: +proj=tmerc"));
  EXPECT_THAT(run.said, HasSubstr("| hill-line | 2.2"));
  EXPECT_THAT(ReadFileWhole(out / "hill-line.alignment.json"), HasSubstr(R"("type": "elements")"));
  EXPECT_THAT(ReadFileWhole(out / "lines.csv"), HasSubstr("hill-line,22"));
  EXPECT_THAT(ReadFileWhole(out / "contradictions.csv"), HasSubstr("line,s_m,offset_m"));
  EXPECT_THAT(
      ReadFileWhole(out / "account.csv"),
      ::testing::ContainsRegex("\nrunning track,\"/features/0/geometry\",m,(2[0-9]+\\.[0-9]+),"));
  EXPECT_THAT(run.said, HasSubstr("| running track | 2.23 km | 2.23 km | 100 |"));
}

/// A tram's straights of 600 m about a street corner of 5 m radius, with a point every 10 m.
std::string StreetCornerMap() {
  constexpr double kPerMetre_deg = 1.0 / 111e3;
  std::string points;
  const auto add = [&](double x_m, double y_m) {
    points += (points.empty() ? "[" : ", [") + std::to_string(x_m * kPerMetre_deg) + ", " +
              std::to_string(y_m * kPerMetre_deg) + "]";
  };
  for (double x_m = -600.0; x_m < 0.0; x_m += 10.0) add(x_m, 0.0);
  for (double rad = 0.0; rad < 1.58; rad += 0.262) {
    add(5.0 * std::sin(rad), 5.0 - 5.0 * std::cos(rad));
  }
  for (double y_m = 15.0; y_m <= 600.0; y_m += 10.0) add(5.0, y_m);
  return R"({"type": "Feature", "properties": {"railway": "tram", "name": "Tram"},
    "geometry": {"type": "LineString", "coordinates": [)" +
         points + "]}}";
}

TEST(Import, CutsALineAtAnArcThatIsTooSharpForVehicles) {
  const TemporaryDirectory directory;
  const fs::path map = directory.path() / "map.geojson";
  const fs::path out = directory.path() / "out";
  WriteFileWhole(map, StreetCornerMap());
  const Ended run = Generate("import " + map.string() + " --min-length 400 --out " + out.string());
  ASSERT_EQ(run.status, 0) << run.said;
  EXPECT_THAT(run.said, HasSubstr("Wrote 2 lines"));
  EXPECT_THAT(run.said, ::testing::ContainsRegex("left out line tram of [0-9]+ m: arc of 10 m "
                                                 "radius at [0-9]+ m: vehicles need 10.4 m"));
  double length_m = 0.0;
  for (const char* part : {"tram-part-1", "tram-part-2"}) {
    const auto json =
        nlohmann::json::parse(ReadFileWhole(out / (std::string(part) + ".alignment.json")));
    for (const auto& element : json["course"]["elements"]) {
      length_m += element["length_m"].get<double>();
      if (element.contains("radius_m")) {
        EXPECT_GE(std::abs(element["radius_m"].get<double>()), 10.4) << part;
      }
    }
  }
  EXPECT_GT(length_m, 1200.0 - 60.0);
}

TEST(Import, GivesTheSameBytesAgain) {
  const TemporaryDirectory directory;
  const fs::path map = directory.path() / "map.geojson";
  WriteFileWhole(map, R"({"type": "FeatureCollection", "features": [
  {"type": "Feature", "properties": {"railway": "rail", "name": "Hill Line", "maxspeed": "60"},
   "geometry": {"type": "LineString", "coordinates":
    [[15.60, 48.20], [15.61, 48.20], [15.62, 48.2003], [15.63, 48.201]]}},
  {"type": "Feature", "properties": {"railway": "rail", "name": "Dale Line"},
   "geometry": {"type": "LineString", "coordinates":
    [[15.60, 48.25], [15.61, 48.251], [15.62, 48.2503], [15.64, 48.251]]}},
  {"type": "Feature", "properties": {"railway": "rail", "name": "Marsh Line"},
   "geometry": {"type": "LineString", "coordinates": [[15.60, 48.15], [15.62, 48.15]]}}]})");
  std::map<std::string, std::string> texts[2];
  for (const int run : {0, 1}) {
    const fs::path out = directory.path() / std::to_string(run);
    ASSERT_EQ(Generate("import " + map.string() + " --out " + out.string()).status, 0);
    for (const fs::directory_entry& file : fs::directory_iterator(out)) {
      texts[run][file.path().filename()] = ReadFileWhole(file.path());
    }
  }
  EXPECT_THAT(texts[0], ::testing::SizeIs(13)) << "two files of each line and seven reports";
  EXPECT_EQ(texts[0], texts[1]);
}

/// A grid of 1e-3 degrees about the map of kMap, on which heights rise to the east by 5 m a cell,
/// which is 6.7 %: too steep for a railway; with `rise_m` 1 it is 1.3 %.
std::string SlopeGrid(double rise_m) {
  std::string text =
      "ncols 60\nnrows 40\nxllcorner 15.58\nyllcorner 48.18\ncellsize 0.001\n"
      "NODATA_value -9999\n";
  for (int row = 0; row < 40; ++row) {
    for (int column = 0; column < 60; ++column) text += NumberText(300.0 + rise_m * column) + " ";
    text += "\n";
  }
  return text;
}

TEST(Import, TakesHeightsFromAnElevationModel) {
  const TemporaryDirectory directory;
  const fs::path map = directory.path() / "map.geojson";
  const fs::path grid = directory.path() / "dem.asc";
  const fs::path out = directory.path() / "out";
  WriteFileWhole(map, kMap);
  WriteFileWhole(grid, SlopeGrid(1.0));
  const Ended run = Generate("import " + map.string() + " --out " + out.string() + " --heights " +
                             grid.string() + " --heights-crs EPSG:4326");
  ASSERT_EQ(run.status, 0) << run.said;
  const auto alignment = nlohmann::json::parse(ReadFileWhole(out / "hill-line.alignment.json"));
  // The middle of column 19.5 is 15.60 degrees. A degree is cos(48.2) * 111.3 km, and the line goes
  // a little to the north, too.
  EXPECT_NEAR(alignment["origin_m"][2], 319.5, 0.1);
  ASSERT_THAT(alignment["gradients_permil"], ::testing::SizeIs(1));
  EXPECT_NEAR(alignment["gradients_permil"][0]["value"], 1e3 / 74.3, 0.1);
  EXPECT_THAT(ReadFileWhole(out / "heights.csv"), HasSubstr("hill-line,"));
  EXPECT_THAT(ReadFileWhole(out / "hill-line.elevation.asc"), HasSubstr("cellsize 112\n"));
}

/// A run on kMap and a grid of SlopeGrid(1.0) of which a part of each row was replaced.
class ImportWithHeights : public ::testing::Test {
 protected:
  Ended Run(const std::string& from, const std::string& by, const std::string& map = kMap) {
    std::string grid = SlopeGrid(1.0);
    for (std::size_t at = 0; (at = grid.find(from, at)) != std::string::npos; at += by.size()) {
      grid.replace(at, from.size(), by);
    }
    WriteFileWhole(directory_.path() / "map.geojson", map);
    WriteFileWhole(directory_.path() / "dem.asc", grid);
    return Generate("import " + (directory_.path() / "map.geojson").string() + " --out " +
                    out_.string() + " --heights " + (directory_.path() / "dem.asc").string() +
                    " --heights-crs EPSG:4326");
  }

  TemporaryDirectory directory_;
  fs::path out_ = directory_.path() / "out";
};

TEST_F(ImportWithHeights, TellsCellsThatCannotBeHeights) {
  // 400 m west of the line, in the rows of up to 500 m beside it.
  const Ended run = Run(" 314 315 ", " -32768 315 ");
  ASSERT_EQ(run.status, 0) << run.said;
  EXPECT_THAT(run.said, ::testing::ContainsRegex("remark heights-void: 1[0-9] cells of an "
                                                 "elevation model with heights that cannot be"));
  EXPECT_THAT(ReadFileWhole(out_ / "left_out.csv"),
              HasSubstr("they count as without one: -32768 m\""));
}

TEST_F(ImportWithHeights, EndsWithAnErrorIfNoLineCanStand) {
  // Over the middle of the line, in each row.
  const Ended run = Run(" 335 336 337 ", " -32768 -32768 -32768 ");
  EXPECT_EQ(run.status, 1);
  EXPECT_THAT(run.said, HasSubstr("Wrote 0 lines to "));
  EXPECT_THAT(run.said, HasSubstr("map.geojson: must have a line that can stand (got 1 left out, "
                                  "with the reasons in " +
                                  (out_ / "left_out.csv").string() + ")"));
}

TEST_F(ImportWithHeights, LeavesOutALineWhoseHeightsNoRailwayHas) {
  // A step of 300 m.
  const Ended run = Run(" 335 336 337 ", " 0 0 0 ");
  EXPECT_EQ(run.status, 1);
  EXPECT_THAT(run.said, HasSubstr("left out line hill-line of 2"));
  EXPECT_THAT(run.said, HasSubstr("its heights must lie within 20 m of gradients that a railway "
                                  "can have (got "));
}

TEST_F(ImportWithHeights, TellsHeightsThatAreFarFromTheGradients) {
  const Ended run = Run(" 335 336 337 ", " 335 350 337 ");
  ASSERT_EQ(run.status, 0) << run.said;
  EXPECT_THAT(run.said, HasSubstr("remark heights-far: "));
  EXPECT_THAT(ReadFileWhole(out_ / "left_out.csv"), HasSubstr("line hill-line at "));
}

/// A point 30 m beside a straight of 3 km that has one every 50 m.
TEST(Import, TellsPointsOfTheMapThatAreFarFromTheLine) {
  const TemporaryDirectory directory;
  const fs::path map = directory.path() / "map.geojson";
  std::string points;
  for (int i = 0; i <= 60; ++i) {
    points += (i == 0 ? "[" : ", [") + std::to_string(15.6 + i * 50.0 / 74e3) + ", " +
              (i == 20 ? "48.20027" : "48.2") + "]";
  }
  WriteFileWhole(map, R"({"type": "Feature", "properties": {"railway": "rail"},
    "geometry": {"type": "LineString", "coordinates": [)" +
                          points + "]}}");
  const fs::path out = directory.path() / "out";
  const Ended run = Generate("import " + map.string() + " --out " + out.string());
  ASSERT_EQ(run.status, 0) << run.said;
  EXPECT_THAT(run.said,
              ::testing::ContainsRegex(
                  "remark places-far: 1 point of a track more than 5 m from the fitted "
                  "line: contradictions.csv has them \\(in .*map.geojson: line line at "));
  EXPECT_THAT(ReadFileWhole(out / "left_out.csv"), HasSubstr("places-far"));
}

TEST(Import, ListsWhatOfTheMapWasNotTakenAsItStands) {
  const TemporaryDirectory directory;
  const fs::path map = directory.path() / "map.geojson";
  const fs::path out = directory.path() / "out";
  std::string text = kMap;
  text.replace(text.find("\"60\""), 4, "\"DE:rural\"");
  WriteFileWhole(map, text);
  const Ended run = Generate("import " + map.string() + " --out " + out.string());
  ASSERT_EQ(run.status, 0) << run.said;
  EXPECT_THAT(run.said, HasSubstr("remark speeds-unread: 1 speed limit that is not understood"));
  EXPECT_THAT(
      ReadFileWhole(out / "left_out.csv"),
      HasSubstr(
          ",speeds-unread,,,\"/features/0/geometry: 1 speed limit that is not understood: its "
          "track counts as without one: 'DE:rural'\""));
}

TEST(Import, NeedsAnElevationModelThatDoesNotEnd) {
  const TemporaryDirectory directory;
  const fs::path map = directory.path() / "map.geojson";
  const fs::path grid = directory.path() / "dem.asc";
  WriteFileWhole(map, kMap);
  WriteFileWhole(
      grid, "ncols 3\nnrows 2\nxllcorner 15.598\nyllcorner 48.195\ncellsize 0.01\n1 2 3\n4 5 6\n");
  const Ended run =
      Generate("import " + map.string() + " --out " + (directory.path() / "out").string() +
               " --heights " + grid.string() + " --heights-crs EPSG:4326");
  EXPECT_EQ(run.status, 1);
  EXPECT_THAT(run.said, HasSubstr("dem.asc: must cover the lines to their ends (got none of "
                                  "hill-line at 15.6, 48.2 degrees)"));
  EXPECT_FALSE(fs::exists(directory.path() / "out"));
}

TEST(Import, TakesHeightsFromTheMap) {
  const TemporaryDirectory directory;
  const fs::path map = directory.path() / "map.geojson";
  WriteFileWhole(map, R"({"type": "LineString", "coordinates":
    [[15.60, 48.20, 250], [15.61, 48.20, 255], [15.62, 48.20, 260], [15.63, 48.20, 265]]})");
  const auto origin_z_m = [&](const std::string& options) -> double {
    const fs::path out = directory.path() / (options.empty() ? "own" : "level");
    const Ended run = Generate("import " + map.string() + " --out " + out.string() + options);
    EXPECT_EQ(run.status, 0) << run.said;
    return nlohmann::json::parse(ReadFileWhole(out / "line.alignment.json"))["origin_m"][2];
  };
  // The line may run either way.
  EXPECT_THAT(origin_z_m(""), ::testing::AnyOf(::testing::DoubleNear(250.0, 0.1),
                                               ::testing::DoubleNear(265.0, 0.1)));
  EXPECT_EQ(origin_z_m(" --level"), 0.0);
}

TEST(Import, CutsTheMapToARectangle) {
  const TemporaryDirectory directory;
  const fs::path map = directory.path() / "map.geojson";
  WriteFileWhole(map, kMap);
  const auto import = [&](const std::string& corners, const std::string& out) {
    return Generate("import " + map.string() + " --min-length 500 --within " + corners + " --out " +
                    (directory.path() / out).string());
  };
  const Ended run = import("15.605,48.1,15.625,48.3", "cut");
  ASSERT_EQ(run.status, 0) << run.said;
  // From 15.61 to 15.62 degrees; the whole line has 2.2 km.
  EXPECT_THAT(run.said, HasSubstr("| hill-line | 0.74"));

  const Ended wrong_way = import("15.625,48.1,15.605,48.3", "wrong");
  EXPECT_EQ(wrong_way.status, 1);
  EXPECT_THAT(wrong_way.said,
              HasSubstr("--within: must be the corner with the least longitude and latitude, then "
                        "that with the greatest (got 15.625,48.1,15.605,48.3)"));
  const Ended elsewhere = import("10,48,11,49", "elsewhere");
  EXPECT_EQ(elsewhere.status, 1);
  EXPECT_THAT(elsewhere.said, HasSubstr("map.geojson in it (got 10,48,11,49)"));
  EXPECT_THAT(import("48.1,15.605,48.3,15.625", "elsewhere").said,
              HasSubstr("map.geojson in it: longitude and latitude are exchanged (got "
                        "48.1,15.605,48.3,15.625)"));
  EXPECT_EQ(import("15.6,48.1,15.7", "three").status, 2);
  EXPECT_EQ(import("15.6,48.1,15.7,99999", "far").status, 2);
  for (const char* refused : {"wrong", "elsewhere", "three", "far"}) {
    EXPECT_FALSE(fs::exists(directory.path() / refused)) << refused;
  }
}

TEST(Import, RefusesAFolderThatIsNotEmpty) {
  const TemporaryDirectory directory;
  const fs::path map = directory.path() / "map.geojson";
  WriteFileWhole(map, kMap);
  const Ended run = Generate("import " + map.string() + " --out " + directory.path().string());
  EXPECT_EQ(run.status, 1);
  EXPECT_THAT(run.said, HasSubstr("--out: must be a new or an empty folder (got " +
                                  directory.path().string() + ")"));
}

TEST(Import, NamesTheMapThatIsTooLarge) {
  const TemporaryDirectory directory;
  const fs::path map = directory.path() / "map.geojson";
  WriteFileWhole(map, R"({"type": "MultiLineString", "coordinates":
    [[[-90, 0], [-89.9, 0]], [[89.9, 0], [90, 0]]]})");
  const Ended run = Generate("import " + map.string() + " --out " + directory.path().string());
  EXPECT_EQ(run.status, 1);
  EXPECT_THAT(run.said,
              HasSubstr("map.geojson: the map must lie about its middle at 0, 0 degrees"));
}

TEST(Import, RefusesWhatItCannotUseInOneLine) {
  const TemporaryDirectory directory;
  const fs::path map = directory.path() / "map.geojson";
  WriteFileWhole(map, kMap);
  const std::string out = " --out " + (directory.path() / "out").string();
  const Ended no_line = Generate("import " + map.string() + out + " --min-length 5000");
  EXPECT_EQ(no_line.status, 1);
  EXPECT_THAT(no_line.said, HasSubstr("must have a line of at least --min-length 5000 m"));
  const Ended no_file = Generate("import " + (directory.path() / "none.json").string() + out);
  EXPECT_EQ(no_file.status, 1);
  EXPECT_THAT(no_file.said, HasSubstr("none.json: "));
  const Ended no_system = Generate("import " + map.string() + out + " --crs EPSG:99999");
  EXPECT_EQ(no_system.status, 1);
  EXPECT_THAT(no_system.said, HasSubstr("--crs: must be a coordinate system that PROJ knows"));
  EXPECT_FALSE(fs::exists(directory.path() / "out"));
}

}  // namespace
}  // namespace railcast
