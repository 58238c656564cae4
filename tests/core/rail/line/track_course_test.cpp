#include "core/rail/line/track_course.h"

#include <gtest/gtest.h>

#include <cmath>

#include "core/rail/network/network_draft.h"
#include "tests/core/rail/test_line.h"

namespace railcast {
namespace {

/// A loop along a canted arc with a gradient.
WorldSpec LoopInACurve() {
  WorldSpec world = CantedArc(1000.0, 800.0);
  world.alignment.gradients_permil = {{0.0, 12.0}};
  world.tracks.push_back({.name = "loop",
                          .offset_m = 6.0,
                          .begin = TurnoutSpec{"main", 300.0, TurnoutType::k9_190, {}, {}},
                          .end = TurnoutSpec{"main", 700.0, TurnoutType::k9_190, {}, {}}});
  return world;
}

TEST(TrackCourse, HasTheFrameOfTheAlignmentWhereItIsParallel) {
  const Alignment alignment(LoopInACurve().alignment);
  const TrackCourse course(0.0, 1000.0, -4.0);
  EXPECT_EQ(course.WorldFromTrack(alignment, 420.0, 0.3, 1.1).matrix(),
            alignment.WorldFromTrack(420.0, -3.7, 1.1).matrix());
}

// Differences over 2 mm: their error is that of the third derivative, below 1e-8 here, and
// rounding, 1e-12 m / 2 mm.
TEST(TrackCourse, LooksAlongItsOwnDirection) {
  const WorldSpec world = LoopInACurve();
  const Alignment alignment(world.alignment);
  const TrackCourse loop = MakeNetwork(world, 1000.0).courses[1];
  constexpr double kStep_m = 1e-3;
  for (const double s_m : {305.0, 318.0, 325.0, 360.0, 500.0, 640.0, 690.0}) {
    const Vector3 way = loop.WorldFromTrack(alignment, s_m + kStep_m).translation() -
                        loop.WorldFromTrack(alignment, s_m - kStep_m).translation();
    const Vector3 x = loop.WorldFromTrack(alignment, s_m).linear().col(0);
    EXPECT_NEAR(std::atan2(x.y(), x.x()), std::atan2(way.y(), way.x()), 1e-8) << s_m;
    EXPECT_NEAR(loop.Heading_rad(alignment, s_m), std::atan2(way.y(), way.x()), 1e-8) << s_m;
  }
}

TEST(TrackCourse, KnowsItsCurvatureInTheWorld) {
  const WorldSpec world = LoopInACurve();
  const Alignment alignment(world.alignment);
  const TrackCourse loop = MakeNetwork(world, 1000.0).courses[1];
  constexpr double kStep_m = 0.01;
  for (const double s_m : {310.0, 323.0, 360.0, 500.0, 640.0}) {
    const Vector3 before = loop.WorldFromTrack(alignment, s_m - kStep_m).translation();
    const Vector3 after = loop.WorldFromTrack(alignment, s_m + kStep_m).translation();
    const double turn_rad =
        loop.Heading_rad(alignment, s_m + kStep_m) - loop.Heading_rad(alignment, s_m - kStep_m);
    const double per_m = turn_rad / (after - before).head<2>().norm();
    EXPECT_NEAR(loop.CurvatureAt(alignment, s_m), per_m, 1e-8) << s_m;
  }
  // Curvatures add in a bent turnout.
  EXPECT_NEAR(loop.CurvatureAt(alignment, 302.0), 1.0 / 800.0 + 1.0 / 190.0, 1e-6);
}

TEST(TrackCourse, RunsSmoothlyFromEndToEnd) {
  const WorldSpec world = LoopInACurve();
  const TrackCourse loop = MakeNetwork(world, 1000.0).courses[1];
  constexpr double kStep_m = 0.01;
  // No curve is tighter than 190 m: the slope changes by less than 1.05 x 0.01 / 190 in a step.
  constexpr double kMostTurn = 1.05 * kStep_m / 190.0;
  TrackOffset before = loop.OffsetAt(299.0);
  for (int i = 1; i <= 40'200; ++i) {
    const TrackOffset here = loop.OffsetAt(299.0 + kStep_m * i);
    ASSERT_NEAR(here.slope, before.slope, kMostTurn) << i;
    // The trapezoidal rule, over which curvature may jump.
    ASSERT_NEAR(here.d_m - before.d_m, 0.5 * kStep_m * (here.slope + before.slope),
                0.5 * kStep_m * kMostTurn)
        << i;
    before = here;
  }
}

TEST(TrackCourse, FollowsOneTrackAndThenAnother) {
  const WorldSpec world = LoopInACurve();
  const Network network = MakeNetwork(world, 1000.0);
  const TrackCourse out = Joined(network.courses[0], network.courses[1], 300.0);
  const TrackCourse through = Joined(out, network.courses[0], 700.0);
  EXPECT_EQ(through.begin_s_m(), 0.0);
  EXPECT_EQ(through.end_s_m(), 1000.0);
  for (const double s_m : {0.0, 299.9, 300.1, 350.0, 500.0, 690.0, 700.1, 900.0}) {
    const TrackCourse& expected = network.courses[s_m > 300.0 && s_m < 700.0 ? 1 : 0];
    EXPECT_EQ(through.OffsetAt(s_m).d_m, expected.OffsetAt(s_m).d_m) << s_m;
    EXPECT_EQ(through.OffsetAt(s_m).slope, expected.OffsetAt(s_m).slope) << s_m;
  }
}

}  // namespace
}  // namespace railcast
