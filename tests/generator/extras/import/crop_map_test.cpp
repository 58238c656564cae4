#include "generator/extras/import/map/read_map.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace railcast {
namespace {

using ::testing::ElementsAre;
using ::testing::SizeIs;

/// Nodes 0 to 6 at longitudes 0 to 6; one way through all of them.
RailMap StraightMap() {
  RailMap map;
  map.ways.push_back({7, {}, {{"name", "Main Line"}}});
  for (int i = 0; i < 7; ++i) {
    map.nodes.push_back({.geographic_deg = Eigen::Vector2d(i, 48.0), .tags = {}});
    map.ways[0].nodes.push_back(static_cast<std::size_t>(i));
  }
  return map;
}

Eigen::AlignedBox2d Between(double west_deg, double east_deg) {
  return {Eigen::Vector2d(west_deg, 47.0), Eigen::Vector2d(east_deg, 49.0)};
}

TEST(CropMap, KeepsTheStretchOfAWayThatLiesInside) {
  const RailMap cropped = CropMap(StraightMap(), Between(1.5, 4.5));
  ASSERT_THAT(cropped.nodes, SizeIs(3));
  EXPECT_EQ(cropped.nodes[0].geographic_deg.x(), 2.0);
  ASSERT_THAT(cropped.ways, SizeIs(1));
  EXPECT_THAT(cropped.ways[0].nodes, ElementsAre(0, 1, 2));
  EXPECT_EQ(cropped.ways[0].id, 7);
  EXPECT_EQ(TagOf(cropped.ways[0].tags, "name"), "Main Line");
}

TEST(CropMap, DividesAWayThatLeavesAndComesBack) {
  RailMap map = StraightMap();
  map.nodes[3].geographic_deg.y() = 50.0;
  map.nodes[5].geographic_deg.y() = 50.0;  // Behind it one point remains, which is no way.
  const RailMap cropped = CropMap(map, Between(-1.0, 5.5));
  ASSERT_THAT(cropped.ways, SizeIs(1));
  EXPECT_THAT(cropped.ways[0].nodes, ElementsAre(0, 1, 2));
  map.nodes[5].geographic_deg.y() = 48.0;
  const RailMap two = CropMap(map, Between(-1.0, 5.5));
  ASSERT_THAT(two.ways, SizeIs(2));
  EXPECT_THAT(two.ways[1].nodes, ElementsAre(3, 4));
}

TEST(CropMap, LeavesOutWhatIsSaidOfWaysOutside) {
  RailMap map = StraightMap();
  map.ways[0].place = "way 7";
  map.ways.push_back({8, {0, 1}, {}, "way 8"});
  for (const char* place : {"way 7", "way 8", "node 3", ""}) {
    map.remarks.push_back({RemarkKind::kTagsUnread, place});
  }
  const RailMap cropped = CropMap(map, Between(1.5, 4.5));
  ASSERT_THAT(cropped.remarks, SizeIs(3));
  EXPECT_EQ(cropped.remarks[0].place, "way 7");
  EXPECT_EQ(cropped.remarks[1].place, "node 3");
}

TEST(CropMap, LeavesOutThingsThatReachOutside) {
  RailMap map = StraightMap();
  for (const double end_deg : {3.0, 6.0}) {
    map.things.push_back(
        {.geographic_deg = {{2.0, 48.0}, {end_deg, 48.0}}, .places_m = {}, .tags = {}});
  }
  const RailMap cropped = CropMap(map, Between(1.5, 4.5));
  ASSERT_THAT(cropped.things, SizeIs(1));
  EXPECT_EQ(cropped.things[0].geographic_deg[1].x(), 3.0);
}

}  // namespace
}  // namespace railcast
