#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "core/rail/line/rail_section.h"
#include "core/rail/line/track_course.h"
#include "core/rail/network/network_draft.h"
#include "tests/core/rail/test_line.h"
#include "tests/support/world_specs.h"

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

// A sum of chords of 1 m is too short by 1 / (24 R^2) of itself.
constexpr double kRadius_m = 200.0;
constexpr double kChords = 1.0 / (24.0 * kRadius_m * kRadius_m);

Alignment LeftArc(double gradient_permil) {
  AlignmentSpec spec = AlignmentOf({{ElementType::kArc, 300.0, kRadius_m}});
  spec.gradients_permil = {{0.0, gradient_permil}};
  return Alignment(spec);
}

TEST(TrackLength, IsThatOfTheTrackItselfBesideACurve) {
  for (const double offset_m : {-4.0, 0.0, 4.5}) {
    const TrackLength length(LeftArc(0.0), TrackCourse(0.0, 300.0, offset_m));
    const double metres_per_m = (kRadius_m - offset_m) / kRadius_m;
    EXPECT_NEAR(length.total_m(), 300.0 * metres_per_m, 300.0 * 1.1 * kChords);
    EXPECT_NEAR(length.UpTo(100.5), 100.5 * metres_per_m, 100.5 * 1.1 * kChords);
  }
}

TEST(TrackLength, CountsTheSlope) {
  AlignmentSpec spec = AlignmentOf({{ElementType::kStraight, 300.0, {}}});
  spec.gradients_permil = {{0.0, 40.0}};
  const TrackLength length(Alignment(spec), TrackCourse(0.0, 300.0, 0.0));
  EXPECT_NEAR(length.total_m(), 300.0 * std::hypot(1.0, 0.04), 1e-9);
}

TEST(TrackLength, MovesAlongTheTrackAndBack) {
  const TrackLength length(LeftArc(0.0), TrackCourse(0.0, 300.0, -4.0));
  const double moved_m = 14.04 * kRadius_m / (kRadius_m + 4.0);
  EXPECT_NEAR(length.MovedFrom(120.3, 14.04), 120.3 + moved_m, 1e-4);
  EXPECT_NEAR(length.MovedFrom(120.3, -14.04), 120.3 - moved_m, 1e-4);
  EXPECT_NEAR(length.MovedFrom(length.MovedFrom(120.3, 14.04), -14.04), 120.3, 1e-9);
  EXPECT_DOUBLE_EQ(length.MovedFrom(120.3, 0.0), 120.3);
}

TEST(TrackLength, GoesOnStraightBeyondTheEnds) {
  const TrackLength length(LeftArc(0.0), TrackCourse(0.0, 300.0, -4.0));
  EXPECT_NEAR(length.MovedFrom(-5.0, -10.0), -15.0, 1e-12);
  EXPECT_NEAR(length.MovedFrom(310.0, 10.0), 320.0, 1e-9);
  EXPECT_NEAR(length.MovedFrom(2.0, -length.UpTo(2.0) - 3.0), -3.0, 1e-9);
  EXPECT_NEAR(length.MovedFrom(299.0, length.total_m() - length.UpTo(299.0) + 3.0), 303.0, 1e-9);
}

double Area(const std::vector<Eigen::Vector2d>& outline_m) {
  double twice_m2 = 0.0;
  for (std::size_t i = 0; i < outline_m.size(); ++i) {
    const Eigen::Vector2d& a = outline_m[i];
    const Eigen::Vector2d& b = outline_m[(i + 1) % outline_m.size()];
    twice_m2 += a.x() * b.y() - a.y() * b.x();
  }
  return 0.5 * twice_m2;
}

// The outline is clockwise, hence the negative sign. docs/physics.md 7.1 gives the polygon's area
// to four digits.
TEST(RailSection, HasTheAreaOfThe60E1Polygon) {
  EXPECT_NEAR(Area(MakeRailSection(true).outline_m), -77.07e-4, 0.005e-4);
  EXPECT_NEAR(Area(MakeRailSection(false).outline_m), -77.07e-4, 0.005e-4);
}

TEST(RailSection, TouchesTopOfRailAndStandsOneRailHeightHigh) {
  const RailSection section = MakeRailSection(true);
  double top_m = -1.0;
  for (const Eigen::Vector2d& point : section.outline_m) top_m = std::max(top_m, point.y());
  EXPECT_DOUBLE_EQ(top_m, 0.0);
  // Due to the inclination of 1:40, the middle of the foot is higher by 172 mm (1 - cos) = 0.05 mm,
  // and the highest point differs from the crown: 0.1 mm.
  EXPECT_NEAR(RailFootMiddle_m().y(), -kRailHeight_m, 0.15e-3);
}

TEST(RailSection, LeansTowardsTheTracksMiddleByOneInForty) {
  const RailSection left = MakeRailSection(true);
  const Eigen::Vector2d foot_m = left.outline_m.back() - left.outline_m.front();
  EXPECT_NEAR(foot_m.y() / foot_m.x(), 1.0 / 40.0, 1e-12);
  const RailSection right = MakeRailSection(false);
  const Eigen::Vector2d right_foot_m = right.outline_m.back() - right.outline_m.front();
  EXPECT_NEAR(right_foot_m.y() / right_foot_m.x(), -1.0 / 40.0, 1e-12);
}

TEST(RailSection, HasARunningBand52MillimetresWide) {
  const RailSection section = MakeRailSection(true);
  const Eigen::Vector2d band_m =
      section.outline_m[section.head_last] - section.outline_m[section.head_first];
  EXPECT_NEAR(band_m.norm(), 0.052, 1e-12);
}

}  // namespace
}  // namespace railcast
