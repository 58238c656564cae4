#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <map>
#include <nlohmann/json.hpp>
#include <string>

#include "core/base/text.h"
#include "core/io/run/run_folder.h"
#include "core/io/write_file.h"
#include "tests/core/io/temporary_directory.h"
#include "tests/generator/run_command.h"
#include "tests/support/exits_with.h"

namespace railcast {
namespace {

namespace fs = std::filesystem;
using ::testing::AllOf;
using ::testing::ContainsRegex;
using ::testing::HasSubstr;

constexpr const char* kMap = R"({"type": "FeatureCollection", "features": [
  {"type": "Feature", "properties": {"railway": "rail", "name": "Hill Line", "maxspeed": "60"},
   "geometry": {"type": "LineString", "coordinates":
    [[15.60, 48.20], [15.61, 48.20], [15.62, 48.2003], [15.63, 48.201]]}}]})";

/// Imports of one map into one folder.
class Import : public ::testing::Test {
 protected:
  /// Imports `map`, which is written before.
  [[nodiscard]] Ended Run(const std::string& map, const std::string& options = "") const {
    WriteFileWhole(map_, map);
    return Generate("import " + map_.string() + " --out " + out_.string() + options);
  }

  /// The same with heights of an elevation model in geographic coordinates.
  [[nodiscard]] Ended RunWithHeights(const std::string& map, const std::string& grid) const {
    WriteFileWhole(directory_.path() / "dem.asc", grid);
    return Run(
        map, " --heights " + (directory_.path() / "dem.asc").string() + " --heights-crs EPSG:4326");
  }

  [[nodiscard]] std::string Text(const std::string& file) const {
    return ReadFileWhole(out_ / file);
  }

  TemporaryDirectory directory_;
  fs::path map_ = directory_.path() / "map.geojson";
  fs::path out_ = directory_.path() / "out";
};

TEST_F(Import, WritesAnAlignmentAndTheReports) {
  ASSERT_THAT(
      Run(kMap),
      ExitsWith(0, AllOf(HasSubstr("projection: +proj=tmerc"), HasSubstr("| hill-line | 2.2"),
                         HasSubstr("| running track | 2.23 km | 2.23 km | 100 |"))));
  EXPECT_THAT(Text("hill-line.alignment.json"), HasSubstr(R"("type": "elements")"));
  EXPECT_THAT(Text("lines.csv"), HasSubstr("hill-line,22"));
  EXPECT_THAT(Text("contradictions.csv"), HasSubstr("line,s_m,offset_m"));
  EXPECT_THAT(Text("account.csv"),
              ContainsRegex("\nrunning track,\"/features/0/geometry\",m,(2[0-9]+\\.[0-9]+),"));
}

TEST_F(Import, WaitsForNoOtherRunInItsFolder) {
  const FolderLock lock(out_);
  EXPECT_THAT(Run(kMap), ExitsWith(1, out_.string() + ": another run is writing here\n"));
  EXPECT_TRUE(fs::is_empty(out_));
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

TEST_F(Import, CutsALineAtAnArcThatIsTooSharpForVehicles) {
  ASSERT_THAT(Run(StreetCornerMap(), " --min-length 400"),
              ExitsWith(0, AllOf(HasSubstr("Wrote 2 lines"),
                                 ContainsRegex("left out line tram of [0-9]+ m: arc of 10 m "
                                               "radius at [0-9]+ m: vehicles need 10.4 m"))));
  double length_m = 0.0;
  for (const char* part : {"tram-part-1", "tram-part-2"}) {
    const auto json = nlohmann::json::parse(Text(std::string(part) + ".alignment.json"));
    for (const auto& element : json["course"]["elements"]) {
      length_m += element["length_m"].get<double>();
      if (element.contains("radius_m")) {
        EXPECT_GE(std::abs(element["radius_m"].get<double>()), 10.4) << part;
      }
    }
  }
  EXPECT_GT(length_m, 1200.0 - 60.0);
}

TEST_F(Import, GivesTheSameBytesAgain) {
  const std::string map = R"({"type": "FeatureCollection", "features": [
  {"type": "Feature", "properties": {"railway": "rail", "name": "Hill Line", "maxspeed": "60"},
   "geometry": {"type": "LineString", "coordinates":
    [[15.60, 48.20], [15.61, 48.20], [15.62, 48.2003], [15.63, 48.201]]}},
  {"type": "Feature", "properties": {"railway": "rail", "name": "Dale Line"},
   "geometry": {"type": "LineString", "coordinates":
    [[15.60, 48.25], [15.61, 48.251], [15.62, 48.2503], [15.64, 48.251]]}},
  {"type": "Feature", "properties": {"railway": "rail", "name": "Marsh Line"},
   "geometry": {"type": "LineString", "coordinates": [[15.60, 48.15], [15.62, 48.15]]}}]})";
  std::map<std::string, std::string> texts[2];
  for (const int run : {0, 1}) {
    out_ = directory_.path() / std::to_string(run);
    ASSERT_THAT(Run(map), ExitsWith(0));
    for (const fs::directory_entry& file : fs::directory_iterator(out_)) {
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

TEST_F(Import, TakesHeightsFromAnElevationModel) {
  ASSERT_THAT(RunWithHeights(kMap, SlopeGrid(1.0)), ExitsWith(0));
  const auto alignment = nlohmann::json::parse(Text("hill-line.alignment.json"));
  // The middle of column 19.5 is 15.60 degrees. A degree is cos(48.2) * 111.3 km, and the line goes
  // a little to the north, too.
  EXPECT_NEAR(alignment["origin_m"][2], 319.5, 0.1);
  ASSERT_THAT(alignment["gradients_permil"], ::testing::SizeIs(1));
  EXPECT_NEAR(alignment["gradients_permil"][0]["value"], 1e3 / 74.3, 0.1);
  EXPECT_THAT(Text("heights.csv"), HasSubstr("hill-line,"));
  EXPECT_THAT(Text("hill-line.elevation.asc"), HasSubstr("cellsize 112\n"));
}

/// The grid of SlopeGrid(1.0) of which a part of each row was replaced.
std::string GridWith(const std::string& from, const std::string& by) {
  std::string grid = SlopeGrid(1.0);
  for (std::size_t at = 0; (at = grid.find(from, at)) != std::string::npos; at += by.size()) {
    grid.replace(at, from.size(), by);
  }
  return grid;
}

using ImportWithHeights = Import;

TEST_F(ImportWithHeights, TellsCellsThatCannotBeHeights) {
  // 400 m west of the line, in the rows of up to 500 m beside it.
  ASSERT_THAT(RunWithHeights(kMap, GridWith(" 314 315 ", " -32768 315 ")),
              ExitsWith(0, ContainsRegex("remark heights-void: 1[0-9] cells of an "
                                         "elevation model with heights that cannot be")));
  EXPECT_THAT(Text("left_out.csv"), HasSubstr("they count as without one: -32768 m\""));
}

TEST_F(ImportWithHeights, EndsWithAnErrorIfNoLineCanStand) {
  // Over the middle of the line, in each row.
  EXPECT_THAT(RunWithHeights(kMap, GridWith(" 335 336 337 ", " -32768 -32768 -32768 ")),
              ExitsWith(1, AllOf(HasSubstr("Wrote 0 lines to "),
                                 HasSubstr("map.geojson: must have a line that can be built (got 1 "
                                           "left out, with the reasons in " +
                                           (out_ / "left_out.csv").string() + ")"))));
}

TEST_F(ImportWithHeights, LeavesOutALineWhoseHeightsNoRailwayHas) {
  // A step of 300 m.
  EXPECT_THAT(RunWithHeights(kMap, GridWith(" 335 336 337 ", " 0 0 0 ")),
              ExitsWith(1, AllOf(HasSubstr("left out line hill-line of 2"),
                                 HasSubstr("its heights must lie within 20 m of gradients that a "
                                           "railway can have (got "))));
}

TEST_F(ImportWithHeights, TellsHeightsThatAreFarFromTheGradients) {
  ASSERT_THAT(RunWithHeights(kMap, GridWith(" 335 336 337 ", " 335 350 337 ")),
              ExitsWith(0, HasSubstr("remark heights-far: ")));
  EXPECT_THAT(Text("left_out.csv"), HasSubstr("line hill-line at "));
}

/// A point 30 m beside a straight of 3 km that has one every 50 m.
TEST_F(Import, TellsPointsOfTheMapThatAreFarFromTheLine) {
  std::string points;
  for (int i = 0; i <= 60; ++i) {
    points += (i == 0 ? "[" : ", [") + std::to_string(15.6 + i * 50.0 / 74e3) + ", " +
              (i == 20 ? "48.20027" : "48.2") + "]";
  }
  ASSERT_THAT(
      Run(R"({"type": "Feature", "properties": {"railway": "rail"},
    "geometry": {"type": "LineString", "coordinates": [)" +
          points + "]}}"),
      ExitsWith(0, ContainsRegex(
                       "remark places-far: 1 point of a track more than 5 m from the fitted "
                       "line: contradictions.csv has them \\(in .*map.geojson: line line at ")));
  EXPECT_THAT(Text("left_out.csv"), HasSubstr("places-far"));
}

TEST_F(Import, ListsWhatOfTheMapWasNotTakenAsItStands) {
  std::string text = kMap;
  text.replace(text.find("\"60\""), 4, "\"DE:rural\"");
  ASSERT_THAT(
      Run(text),
      ExitsWith(0, HasSubstr("remark speeds-unread: 1 speed limit that is not understood")));
  EXPECT_THAT(Text("left_out.csv"),
              HasSubstr(",speeds-unread,,,\"/features/0/geometry: 1 speed limit that is not "
                        "understood: its track counts as without one: 'DE:rural'\""));
}

TEST_F(Import, NeedsAnElevationModelThatDoesNotEnd) {
  EXPECT_THAT(RunWithHeights(kMap,
                             "ncols 3\nnrows 2\nxllcorner 15.598\nyllcorner 48.195\n"
                             "cellsize 0.01\n1 2 3\n4 5 6\n"),
              ExitsWith(1, HasSubstr("dem.asc: must cover the lines to their ends (got none of "
                                     "hill-line at 15.6, 48.2 degrees)")));
  EXPECT_FALSE(fs::exists(out_));
}

TEST_F(Import, TakesHeightsFromTheMap) {
  const auto origin_z_m = [&](const std::string& options) -> double {
    EXPECT_THAT(Run(R"({"type": "LineString", "coordinates":
    [[15.60, 48.20, 250], [15.61, 48.20, 255], [15.62, 48.20, 260], [15.63, 48.20, 265]]})",
                    options),
                ExitsWith(0));
    const double z_m = nlohmann::json::parse(Text("line.alignment.json"))["origin_m"][2];
    fs::remove_all(out_);
    return z_m;
  };
  // The line may run either way.
  EXPECT_THAT(origin_z_m(""), ::testing::AnyOf(::testing::DoubleNear(250.0, 0.1),
                                               ::testing::DoubleNear(265.0, 0.1)));
  EXPECT_EQ(origin_z_m(" --level"), 0.0);
}

TEST_F(Import, CutsTheMapToARectangle) {
  const auto import = [&](const std::string& corners) {
    return Run(kMap, " --min-length 500 --within " + corners);
  };
  EXPECT_THAT(import("15.625,48.1,15.605,48.3"),
              ExitsWith(1, HasSubstr("--within: must be the corner with the least longitude and "
                                     "latitude, then that with the greatest (got "
                                     "15.625,48.1,15.605,48.3)")));
  EXPECT_THAT(import("10,48,11,49"),
              ExitsWith(1, HasSubstr("map.geojson in it (got 10,48,11,49)")));
  EXPECT_THAT(import("48.1,15.605,48.3,15.625").said,
              HasSubstr("map.geojson in it: longitude and latitude are exchanged (got "
                        "48.1,15.605,48.3,15.625)"));
  EXPECT_EQ(import("15.6,48.1,15.7").status, 2);
  EXPECT_EQ(import("15.6,48.1,15.7,99999").status, 2);
  EXPECT_FALSE(fs::exists(out_));
  // From 15.61 to 15.62 degrees; the whole line has 2.2 km.
  EXPECT_THAT(import("15.605,48.1,15.625,48.3"), ExitsWith(0, HasSubstr("| hill-line | 0.74")));
}

TEST_F(Import, RefusesAFolderThatIsNotEmpty) {
  WriteFileWhole(map_, kMap);
  const std::string folder = directory_.path().string();
  EXPECT_THAT(
      Generate("import " + map_.string() + " --out " + folder),
      ExitsWith(1, HasSubstr("--out: must be a new or an empty folder (got " + folder + ")")));
}

TEST_F(Import, NamesTheMapThatIsTooLarge) {
  EXPECT_THAT(
      Run(R"({"type": "MultiLineString", "coordinates":
    [[[-90, 0], [-89.9, 0]], [[89.9, 0], [90, 0]]]})"),
      ExitsWith(1, HasSubstr("map.geojson: the map must lie about its middle at 0, 0 degrees")));
}

TEST_F(Import, RefusesWhatItCannotUseInOneLine) {
  EXPECT_THAT(Run(kMap, " --min-length 5000"),
              ExitsWith(1, HasSubstr("must have a line of at least --min-length 5000 m")));
  EXPECT_THAT(Run(kMap, " --crs EPSG:99999"),
              ExitsWith(1, HasSubstr("--crs: must be a coordinate system that PROJ knows")));
  EXPECT_THAT(
      Generate("import " + (directory_.path() / "none.json").string() + " --out " + out_.string()),
      ExitsWith(1, HasSubstr("none.json: ")));
  EXPECT_FALSE(fs::exists(out_));
}

}  // namespace
}  // namespace railcast
