#include "core/detect/beam/wire_set.h"

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

TEST(WireSet, BallsContainAWireThatMovesAtAllTimes) {
  WireSet wires;
  std::vector<Vector3> points_m;
  std::vector<Vector3> moves_m;
  for (int i = 0; i < 20; ++i) {
    points_m.emplace_back(5.0 * i, 0.0, 6.0);
    moves_m.emplace_back(0.0, 0.01 * i * (19 - i), 0.1);
  }
  wires.Add(points_m, 0.006, 3, moves_m);
  EXPECT_FLOAT_EQ(wires.segments[9].travel_m, std::hypot(0.9F, 0.1F));
  for (const WireGroup& group : wires.groups) {
    for (std::uint32_t i = group.first_segment; i < group.end_segment; ++i) {
      for (const float shutter : {0.0F, 0.5F, 1.0F}) {
        const WireSegment now = SegmentAt(wires.segments[i], shutter);
        for (const Eigen::Vector3f& end_m : {now.begin_m, now.end_m}) {
          for (const WireBall& ball : {group.ball, wires.balls[i]}) {
            EXPECT_LE((end_m - ball.center_m).norm() + now.radius_m, ball.radius_m * 1.000001F);
          }
        }
      }
    }
  }
  const WireSegment end = SegmentAt(wires.segments[9], 1.0F);
  EXPECT_TRUE(end.begin_m.isApprox((points_m[9] + moves_m[9]).cast<float>()));
  EXPECT_TRUE(end.end_m.isApprox((points_m[10] + moves_m[10]).cast<float>()));
  EXPECT_EQ(end.travel_m, 0.0F);
}

}  // namespace
}  // namespace railcast
