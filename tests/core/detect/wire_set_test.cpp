#include "core/detect/wire_set.h"

#include <gtest/gtest.h>

#include <cmath>

namespace railcast {
namespace {

TEST(WireSet, EverySegmentIsInsideTheBallOfItsGroupAndInOneGroup) {
  WireSet wires;
  for (const int num_points : {2, 3, 9, 10, 40}) {
    std::vector<Vector3> points_m;
    for (int i = 0; i < num_points; ++i) {
      points_m.emplace_back(10.0 * std::cos(0.3 * i), 10.0 * std::sin(0.3 * i), 0.1 * i);
    }
    wires.Add(points_m, 0.5, 3);
  }
  EXPECT_EQ(wires.segments.size(), 1U + 2U + 8U + 9U + 39U);
  std::uint32_t next = 0;
  for (const WireGroup& group : wires.groups) {
    EXPECT_EQ(group.first_segment, next);
    next = group.end_segment;
    for (std::uint32_t i = group.first_segment; i < next; ++i) {
      const WireSegment& segment = wires.segments[i];
      for (const Eigen::Vector3f& end_m : {segment.begin_m, segment.end_m}) {
        EXPECT_LE((end_m - group.ball.center_m).norm() + segment.radius_m,
                  group.ball.radius_m * 1.000001F);
      }
    }
  }
  EXPECT_EQ(next, wires.segments.size());
}

}  // namespace
}  // namespace railcast
