#include "generator/extras/import/lines/divided_line.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <optional>
#include <vector>

#include "generator/extras/import/lines/imported_line.h"
#include "generator/extras/import/network/line_world.h"
#include "generator/extras/import/structures/standing_world.h"

namespace railcast {
namespace {

using ::testing::SizeIs;

/// A map of one way, and the line that it makes.
struct OneLine {
  explicit OneLine(const std::vector<Eigen::Vector2d>& points_m) {
    MapWay way{1, {}, {{"railway", "tram"}, {"maxspeed", "30"}}};
    for (const Eigen::Vector2d& point_m : points_m) {
      way.nodes.push_back(map.nodes.size());
      line.nodes.push_back(map.nodes.size());
      map.nodes.push_back({.place_m = point_m, .tags = {}});
    }
    line.ways.assign(points_m.size() - 1, 0);
    map.ways.push_back(std::move(way));
  }

  RailMap map{.nodes = {}, .ways = {}, .things = {}, .attribution = "Test"};
  TrackLine line;
};

void AddArc(const Eigen::Vector2d& middle_m,
            double radius_m,
            double from_rad,
            double to_rad,
            std::vector<Eigen::Vector2d>& points_m) {
  const int num_steps = static_cast<int>(std::ceil(std::abs(to_rad - from_rad) / 0.2));
  for (int i = 0; i <= num_steps; ++i) {
    const double rad = std::lerp(from_rad, to_rad, 1.0 * i / num_steps);
    points_m.emplace_back(middle_m + radius_m * Eigen::Vector2d(std::cos(rad), std::sin(rad)));
  }
}

/// Out for 500 m, around a loop of 20 m radius, and back beside the first track, 4 m from it.
std::vector<Eigen::Vector2d> TramWithLoop_m() {
  std::vector<Eigen::Vector2d> points_m;
  for (double x_m = 0.0; x_m < 460.0; x_m += 20.0) points_m.emplace_back(x_m, 0.0);
  AddArc({500.0, 2.0}, 20.0, -0.75 * std::numbers::pi, 0.75 * std::numbers::pi, points_m);
  for (double x_m = 460.0; x_m > 0.0; x_m -= 20.0) points_m.emplace_back(x_m, 4.0);
  return points_m;
}

TEST(DividedLine, IsCutInTheMiddleOfALoopBeforeWhichItRunsBesideItself) {
  const OneLine tram(TramWithLoop_m());
  const std::vector<TrackLine> parts = DividedWhereItMeetsItself(tram.map, tram.line);
  ASSERT_THAT(parts, SizeIs(2));
  EXPECT_EQ(parts[0].nodes.back(), parts[1].nodes.front());
  EXPECT_NEAR(tram.map.nodes[parts[0].nodes.back()].place_m.x(), 520.0, 5.0);
  EXPECT_NEAR(LengthOf_m(tram.map, parts[0]) + LengthOf_m(tram.map, parts[1]),
              LengthOf_m(tram.map, tram.line), 1e-9);
}

TEST(DividedLine, HasPartsWithWorldsThatStandThoughTheWholeHasNone) {
  const OneLine tram(TramWithLoop_m());
  const auto fault_of = [&](const TrackLine& line) {
    const ImportedLine imported = ImportLine(tram.map, line, {});
    LineWorld world = MakeLineWorld(tram.map, line, imported);
    return MakeStand(imported.alignment, std::nullopt, world);
  };
  EXPECT_NE(fault_of(tram.line), std::nullopt);
  for (const TrackLine& part : DividedWhereItMeetsItself(tram.map, tram.line)) {
    EXPECT_EQ(fault_of(part), std::nullopt);
  }
}

TEST(DividedLine, StaysWholeIfItKeepsClearOfItself) {
  std::vector<Eigen::Vector2d> straight_m;
  for (double x_m = 0.0; x_m <= 1000.0; x_m += 1.0) straight_m.emplace_back(x_m, 0.3 * (x_m > 500));
  std::vector<Eigen::Vector2d> ring_m;
  AddArc({0.0, 0.0}, 300.0, 0.0, 2.0 * std::numbers::pi, ring_m);
  // The smallest turn that a line may have, back to 20 m beside itself.
  std::vector<Eigen::Vector2d> hairpin_m = {{0.0, -10.0}, {200.0, -10.0}};
  AddArc({400.0, 0.0}, 10.0, -0.5 * std::numbers::pi, 0.5 * std::numbers::pi, hairpin_m);
  hairpin_m.emplace_back(0.0, 10.0);
  for (const auto& points_m : {straight_m, ring_m, hairpin_m}) {
    const OneLine line(points_m);
    EXPECT_THAT(DividedWhereItMeetsItself(line.map, line.line), SizeIs(1));
  }
}

}  // namespace
}  // namespace railcast
