#include "generator/extras/import/lines/track_lines.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <vector>

namespace railcast {
namespace {

using ::testing::ElementsAre;
using ::testing::SizeIs;

/// A line along x with nodes 0 to 4, and a branch that leaves it at node 2 by `angle_deg`.
RailMap MapWithBranch(double angle_deg) {
  RailMap map;
  for (int i = 0; i < 5; ++i) {
    map.nodes.push_back({.place_m = Eigen::Vector2d(100.0 * i, 0.0), .tags = {}});
  }
  const double angle_rad = angle_deg * M_PI / 180.0;
  map.nodes.push_back(
      {.place_m = Eigen::Vector2d(200.0 + 150.0 * std::cos(angle_rad), 150.0 * std::sin(angle_rad)),
       .tags = {}});
  map.ways.push_back({10, {0, 1, 2}, {{"railway", "rail"}, {"name", "Main Line"}, {"ref", "1"}}});
  // Drawn against the others.
  map.ways.push_back({11, {4, 3, 2}, {{"railway", "rail"}, {"name", "Main Line"}, {"ref", "1"}}});
  map.ways.push_back({12, {2, 5}, {{"railway", "rail"}, {"ref", "2"}}});
  return map;
}

TEST(TrackLines, GoStraightOnOverASwitch) {
  const RailMap map = MapWithBranch(6.0);
  const std::vector<TrackLine> lines = FindLines(map, 0.0);
  ASSERT_THAT(lines, SizeIs(2));
  EXPECT_THAT(lines[0].nodes,
              ::testing::AnyOf(ElementsAre(0, 1, 2, 3, 4), ElementsAre(4, 3, 2, 1, 0)));
  EXPECT_EQ(lines[0].name, "main-line-1");
  EXPECT_THAT(lines[1].nodes, ::testing::UnorderedElementsAre(2, 5));
  EXPECT_EQ(lines[1].name, "2");
  EXPECT_NEAR(LengthOf_m(map, lines[1]), 150.0, 1e-9);
}

TEST(TrackLines, KeepToTheirRefWhereTheBranchIsALittleStraighter) {
  RailMap map = MapWithBranch(0.0);
  map.nodes[3].place_m.y() = 5.0;  // The main line turns by 2.9 degrees.
  const std::vector<TrackLine> lines = FindLines(map, 0.0);
  ASSERT_THAT(lines, SizeIs(2));
  EXPECT_THAT(lines[0].nodes, SizeIs(5));
}

TEST(TrackLines, EndWhereTheOnlyWayTurnsTooSharply) {
  RailMap map = MapWithBranch(30.0);
  map.ways.erase(map.ways.begin() + 1);
  EXPECT_THAT(FindLines(map, 0.0), SizeIs(2));
}

TEST(TrackLines, LeaveOutSidingsAndWhatIsShort) {
  RailMap map = MapWithBranch(6.0);
  EXPECT_THAT(FindLines(map, 200.0), SizeIs(1));
  map.ways[2].tags["service"] = "siding";
  EXPECT_THAT(FindLines(map, 0.0), SizeIs(1));
}

TEST(TrackLines, UseEveryWayOnceOnALoop) {
  RailMap map;
  constexpr int kNumNodes = 40;
  for (int i = 0; i < kNumNodes; ++i) {
    const double angle_rad = 2.0 * M_PI * i / kNumNodes;
    map.nodes.push_back(
        {.place_m = 500.0 * Eigen::Vector2d(std::cos(angle_rad), std::sin(angle_rad)), .tags = {}});
  }
  for (std::size_t i = 0; i < kNumNodes; ++i) {
    map.ways.push_back({static_cast<std::int64_t>(i), {i, (i + 1) % kNumNodes}, {}});
  }
  const std::vector<TrackLine> lines = FindLines(map, 0.0);
  ASSERT_THAT(lines, SizeIs(1));
  EXPECT_THAT(lines[0].ways, SizeIs(kNumNodes));
}

RailMap MapOfOneWay(const std::vector<Eigen::Vector2d>& places_m) {
  RailMap map;
  MapWay way{1, {}, {}};
  for (const Eigen::Vector2d& place_m : places_m) {
    way.nodes.push_back(map.nodes.size());
    map.nodes.push_back({.place_m = place_m, .tags = {}});
  }
  map.ways = {way};
  return map;
}

TEST(TrackLines, LeaveOutWhatStaysWithinHalfAMetre) {
  const RailMap map = MapOfOneWay({{0.0, 0.0}, {0.3, 0.0}, {0.0, 0.0}, {0.0, 0.3}, {0.1, 0.0}});
  EXPECT_THAT(FindLines(map, 0.0), SizeIs(0));
  EXPECT_THAT(FindLines(map, 1.0), SizeIs(0)) << "although 1.2 m were drawn";
}

TEST(TrackLines, EndWhereTheyTurnBack) {
  const RailMap map =
      MapOfOneWay({{0.0, 0.0}, {1000.0, 0.0}, {2000.0, 0.0}, {1000.0, 1.0}, {600.0, 0.0}});
  const std::vector<TrackLine> lines = FindLines(map, 0.0);
  ASSERT_THAT(lines, SizeIs(2));
  EXPECT_NEAR(LengthOf_m(map, lines[0]), 2000.0, 0.1);
  EXPECT_NEAR(LengthOf_m(map, lines[1]), 1400.0, 0.1);
}

TEST(TrackLines, GoOnOverAFewCentimetresInAnyDirection) {
  RailMap map = MapWithBranch(6.0);
  map.ways.pop_back();
  // Node 5 lies 6 cm beside node 2, and the next way begins with it.
  map.nodes[5].place_m = {200.0, 0.06};
  map.ways[1].nodes = {4, 3, 5, 2};
  EXPECT_THAT(FindLines(map, 0.0), SizeIs(1));
}

TEST(TrackLines, HaveNamesThatFitAFileName) {
  RailMap map = MapWithBranch(6.0);
  for (MapWay& way : map.ways) way.tags = {{"name", std::string(300, 'a')}};
  const std::vector<TrackLine> lines = FindLines(map, 0.0);
  ASSERT_THAT(lines, SizeIs(2));
  EXPECT_EQ(lines[0].name, std::string(100, 'a'));
  EXPECT_EQ(lines[1].name, std::string(98, 'a') + "-2");
}

}  // namespace
}  // namespace railcast
