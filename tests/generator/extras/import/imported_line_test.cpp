#include "generator/extras/import/lines/imported_line.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <string>

#include "core/io/write_file.h"
#include "generator/extras/import/import_files.h"
#include "generator/extras/import/lines/line_heights.h"
#include "generator/extras/import/lines/track_lines.h"
#include "generator/extras/import/map/map_projection.h"
#include "generator/extras/import/map/read_map.h"
#include "railcast/scenario.h"
#include "tests/core/io/temporary_directory.h"

namespace railcast {
namespace {

using ::testing::HasSubstr;
using ::testing::SizeIs;

/// A straight of 600 m, a quarter circle of 500 m radius and another straight, with a point every
/// 20 m and one in the middle of the arc that is 3 m off; 80 km/h, and 60 from the arc on.
RailMap Corner() {
  RailMap map;
  map.attribution = "Test";
  constexpr double kRadius_m = 500.0;
  const double arc_m = kRadius_m * M_PI / 2.0;
  for (double s_m = 0.0; s_m <= 1200.0 + arc_m; s_m += 20.0) {
    const double inside_m = std::clamp(s_m - 600.0, 0.0, arc_m);
    const double angle_rad = inside_m / kRadius_m;
    Eigen::Vector2d place_m(std::min(s_m, 600.0) + kRadius_m * std::sin(angle_rad),
                            kRadius_m * (1.0 - std::cos(angle_rad)));
    place_m.y() += std::max(0.0, s_m - 600.0 - arc_m);
    if (std::abs(s_m - 1000.0) < 1.0) place_m.y() += 3.0;
    map.nodes.push_back({.place_m = place_m, .tags = {}});
  }
  MapWay before{1, {}, {{"maxspeed", "80"}}};
  MapWay after{2, {}, {{"maxspeed", "60"}}};
  for (std::size_t i = 0; i < map.nodes.size(); ++i) {
    if (i <= 30) before.nodes.push_back(i);
    if (i >= 30) after.nodes.push_back(i);
  }
  map.ways = {before, after};
  return map;
}

/// The corner with 90 mm of cant in its arc and ramps of 60 m, as a survey has it.
RailMap CantedCorner() {
  RailMap map = Corner();
  for (std::size_t i = 0; i < map.nodes.size(); ++i) {
    const double s_m = 20.0 * static_cast<double>(i);
    const double inside_m = std::min(s_m - 600.0, 600.0 + 250.0 * M_PI - s_m);
    map.nodes[i].cant_mm = std::clamp(90.0 * (inside_m / 60.0 + 0.5), 0.0, 90.0);
  }
  return map;
}

TEST(ImportedLine, TakesSurveyedCantsWithTheOuterRailHigher) {
  RailMap map = CantedCorner();
  const auto cants = [&] {
    const TrackLine track = FindLines(map, 0.0).front();
    ImportedLine line = ImportLine(map, track, {});
    SetCants(map, track, {}, line);
    return line.alignment;
  };
  const AlignmentSpec left = cants();
  // Both ends of either ramp, as points lie; the others are between two.
  EXPECT_THAT(left.cants_mm, SizeIs(::testing::AllOf(::testing::Ge(6U), ::testing::Le(10U))));
  const double middle_s_m = 600.0 + 125.0 * M_PI;
  const auto height_mm = [](const AlignmentSpec& spec, double s_m) {
    return -1500.0 * std::sin(Alignment(spec).At(s_m).cant_rad);
  };
  // Lines may begin at either end.
  const double turn = std::copysign(1.0, Alignment(left).At(middle_s_m).curvature_per_m);
  EXPECT_NEAR(height_mm(left, middle_s_m), turn * 90.0, 1e-6);
  EXPECT_EQ(height_mm(left, 300.0), 0.0);
  EXPECT_EQ(height_mm(left, 1600.0), 0.0);
  for (MapNode& node : map.nodes) node.place_m.y() *= -1.0;
  EXPECT_NEAR(height_mm(cants(), middle_s_m), -turn * 90.0, 1e-6);
  ImportedLine line;
  line.alignment = left;
  EXPECT_THAT(AlignmentFileText(line, {}), HasSubstr(R"("cants_mm": [)"));
}

TEST(ImportedLine, HasNoCantWhereASurveyedLineSaysNothing) {
  RailMap map = CantedCorner();
  for (std::size_t i = 0; i < 25; ++i) map.nodes[i].cant_mm.reset();
  const TrackLine track = FindLines(map, 0.0).front();
  ImportedLine line = ImportLine(map, track, {});
  // The first point with a cant, which is 0 there, and one in the straight with none.
  map.nodes[25].cant_mm = 60.0;
  SetCants(map, track, {}, line);
  const double from_west_m = Alignment(line.alignment).At(0.0).position_m.x() < 600.0
                                 ? 0.0
                                 : Alignment(line.alignment).length_m();
  const auto cant_rad = [&](double west_m) {
    return Alignment(line.alignment).At(std::abs(from_west_m - west_m)).cant_rad;
  };
  EXPECT_EQ(cant_rad(200.0), 0.0);
  EXPECT_EQ(cant_rad(470.0), 0.0);
  EXPECT_NE(cant_rad(500.0), 0.0);
}

TEST(ImportedLine, LeansByItsOwnCurveBesideASharperOne) {
  // A left arc of 2,000 m radius and a right one of 300 m, point by point.
  RailMap map;
  Eigen::Vector2d place_m(0.0, 0.0);
  double heading_rad = 0.0;
  MapWay way{1, {}, {}};
  for (int i = 0; i <= 80; ++i) {
    const double s_m = 10.0 * i;
    way.nodes.push_back(map.nodes.size());
    map.nodes.push_back({.place_m = place_m,
                         .cant_mm = s_m < 700.0 ? std::min(40.0, 700.0 - s_m)
                                                : std::min(130.0, 2.0 * (s_m - 700.0)),
                         .tags = {}});
    heading_rad += 10.0 * (s_m < 700.0 ? 1.0 / 2000.0 : -1.0 / 300.0);
    place_m += 10.0 * Eigen::Vector2d(std::cos(heading_rad), std::sin(heading_rad));
  }
  map.ways = {way};
  const TrackLine track = FindLines(map, 0.0).front();
  ImportedLine line = ImportLine(map, track, {});
  SetCants(map, track, {}, line);
  const Alignment alignment(line.alignment);
  for (const ChainageValue& entry : line.alignment.cants_mm) {
    const double curvature_per_m = alignment.At(entry.s_m).curvature_per_m;
    EXPECT_GE(entry.value * curvature_per_m, 0.0) << entry.s_m;
    EXPECT_FALSE(std::signbit(entry.value) && entry.value == 0.0);
  }
}

TEST(ImportedLine, HasCantsByTheRuleWithoutASurvey) {
  const RailMap map = Corner();
  const TrackLine track = FindLines(map, 0.0).front();
  ImportedLine line = ImportLine(map, track, {});
  SetCants(map, track, {}, line);
  EXPECT_TRUE(line.alignment.cants_mm.empty());
}

TEST(ImportedLine, HasTheMapsCurveAndSpeeds) {
  const RailMap map = Corner();
  const TrackLine track = FindLines(map, 0.0).front();
  const ImportedLine line = ImportLine(map, track, {});
  EXPECT_EQ(line.quality.num_points, map.nodes.size());
  EXPECT_NEAR(line.quality.tightest_radius_m, 500.0, 25.0);
  EXPECT_LT(line.quality.median_m, 0.3);
  EXPECT_LT(line.quality.num_elements, 10U);
  EXPECT_EQ(line.quality.sign_changes_per_km, 0.0);
  EXPECT_GT(line.quality.sign_changes_before_per_km, 1.0) << "a spline swings about the point";
  ASSERT_THAT(line.alignment.speed_limits_kmph, SizeIs(2));
  const Alignment alignment(line.alignment);
  // The line may run either way.
  const bool is_forward = line.alignment.speed_limits_kmph[0].value == 80.0;
  EXPECT_NEAR(line.alignment.speed_limits_kmph[1].s_m,
              is_forward ? 600.0 : alignment.length_m() - 600.0, 10.0);
  EXPECT_EQ(line.alignment.attribution, "Test");
}

TEST(ImportedLine, NamesThePointsThatContradictTheOthers) {
  const RailMap map = Corner();
  const ImportedLine line = ImportLine(map, FindLines(map, 0.0).front(), {});
  ASSERT_THAT(line.contradictions, SizeIs(1));
  EXPECT_NEAR(std::abs(line.contradictions[0].offset_m), 3.0 * std::cos(0.8), 0.8);
  EXPECT_THAT(ContradictionsCsv({line}), HasSubstr("line,"));
}

TEST(ImportedLine, IsAnAlignmentFileOfAScenario) {
  const TemporaryDirectory directory;
  const RailMap map = Corner();
  const ImportedLine line = ImportLine(map, FindLines(map, 0.0).front(), {});
  WriteFileWhole(directory.path() / "corner.alignment.json",
                 AlignmentFileText(line, {.definition = "EPSG:31256", .origin_m = {1.0, 2.0}}));
  const std::string scenarios = RAILCAST_SOURCE_DIR "/scenarios/";
  WriteFileWhole(directory.path() / "scenario.json",
                 R"({"version": 1, "file": ")" + scenarios +
                     R"(minimal.json", "world": {"alignment": "corner.alignment.json"}})");
  const ScenarioSpec scenario = ReadScenario(directory.path() / "scenario.json");
  const Alignment read(scenario.world.alignment);
  const Alignment fitted(line.alignment);
  EXPECT_NEAR(read.length_m(), fitted.length_m(), 1e-3);
  const double end_m = read.length_m();
  EXPECT_LT((read.At(end_m).position_m - fitted.At(end_m).position_m).norm(), 5e-3);
  EXPECT_THAT(scenario.world.alignment.attribution,
              HasSubstr("Coordinates: EPSG:31256, minus (1.000, 2.000) m."));
}

/// The lines of a real extract, the long ones left out for the sake of time;
/// docs/results/import.md has them all.
TEST(ImportedLine, FitsTheShortLinesAroundSanktPoelten) {
  const std::filesystem::path file =
      RAILCAST_SHARED_DATA_DIR "/osm_sankt_poelten/sankt_poelten.json";
  if (!std::filesystem::exists(file)) GTEST_SKIP() << file << " is absent";
  RailMap map = ReadMap(file);
  static_cast<void>(ProjectMap("", map));
  int num_lines = 0;
  for (const TrackLine& track : FindLines(map, 1000.0)) {
    if (LengthOf_m(map, track) > 7000.0) continue;
    ++num_lines;
    const ImportedLine line = ImportLine(map, track, {});
    EXPECT_LE(line.quality.median_m, 0.3) << track.name;
    EXPECT_LE(line.quality.p99_m, 1.5) << track.name;
    EXPECT_LT(line.quality.sign_changes_per_km, line.quality.sign_changes_before_per_km)
        << track.name;
    EXPECT_GT(line.quality.tightest_radius_m, line.quality.tightest_radius_before_m) << track.name;
  }
  EXPECT_GE(num_lines, 5);
}

}  // namespace
}  // namespace railcast
