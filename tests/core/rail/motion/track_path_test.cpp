#include "core/rail/motion/track_path.h"

#include "tests/support/world_specs.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

namespace railcast {
namespace {

/// A canted arc to the left with a rising gradient.
Alignment Arc() {
  AlignmentSpec spec = AlignmentOf({{ElementType::kArc, 500.0, 400.0}});
  spec.gradients_permil = {{0.0, 20.0}};
  spec.speed_limits_kmph = {{0.0, 80.0}};
  return Alignment(spec);
}

/// A track at the alignment itself.
TrackCourse Axis() {
  return {0.0, 1e4, 0.0};
}

SpeedProfile Standing(double s_m) {
  return {{}, s_m};
}

TEST(TrackPath, FollowsGradientCurvatureAndCant) {
  const TrackPath path(Axis(), {.d_m = 1.0, .h_m = 0.5}, Standing(200.0));
  const Alignment alignment = Arc();
  EXPECT_FALSE(path.moves());
  const Transform world_from_object = path.WorldFromObject(alignment, 0);
  EXPECT_TRUE(world_from_object.isApprox(alignment.WorldFromTrack(200.0, 1.0, 0.5), 1e-12));
  // It follows the gradient and leans to the left.
  EXPECT_NEAR(world_from_object.linear()(2, 0), std::sin(std::atan(0.02)), 1e-12);
  EXPECT_LT(world_from_object.linear()(2, 1), -0.08);
}

/// A level arc of 350 m to the left.
Alignment LevelArc() {
  return Alignment(AlignmentOf({{ElementType::kArc, 500.0, 350.0}}));
}

// A chord of length L between two points of a circle of radius R turns by asin(L / 2R) from the
// tangent at its end: by 10 mrad for 7 m at 350 m, on the side of the curve's outside.
TEST(TrackPath, PutsABodyOnTheChordBetweenItsPivots) {
  const Alignment alignment = LevelArc();
  for (const double distance_m : {7.0, 10.4, 19.0}) {
    for (const double d_m : {0.0, -4.0}) {
      const TrackPath path(Axis(), {.d_m = d_m, .pivot_distance_m = distance_m}, Standing(200.0));
      const Transform world_from_body = path.WorldFromObject(alignment, 0);
      const double yaw_rad = 200.0 / 350.0 - std::asin(0.5 * distance_m / (350.0 - d_m));
      EXPECT_NEAR(world_from_body.linear()(0, 0), std::cos(yaw_rad), 1e-11);
      EXPECT_NEAR(world_from_body.linear()(1, 0), std::sin(yaw_rad), 1e-11);
      EXPECT_TRUE(world_from_body.linear().col(2).isApprox(Vector3::UnitZ(), 1e-12));
      EXPECT_TRUE(world_from_body.translation().isApprox(
          alignment.WorldFromTrack(200.0, d_m).translation(), 1e-12));
      // The rear pivot is on the track, too.
      const Vector3 rear = world_from_body * Vector3(-distance_m, 0.0, 0.0);
      const Vector3 middle(0.0, 350.0, 0.0);
      EXPECT_NEAR((rear - middle).norm(), 350.0 - d_m, 1e-9);
    }
  }
}

TEST(TrackPath, TurnsABodyByTenMilliradiansWithSevenMetresAt350) {
  const Alignment alignment = LevelArc();
  const TrackPath body(Axis(), {.pivot_distance_m = 7.0}, Standing(200.0));
  const TrackPath point(Axis(), {}, Standing(200.0));
  const Vector3 ahead(100.0, 0.0, 0.0);
  const Vector3 apart =
      body.WorldFromObject(alignment, 0) * ahead - point.WorldFromObject(alignment, 0) * ahead;
  EXPECT_NEAR(apart.norm(), 1.0, 1e-3);
}

TEST(TrackPath, PutsAReversedBodyOnTheChordAheadOfItsChainage) {
  const Alignment alignment = LevelArc();
  const TrackPath path(Axis(), {.heading_rad = std::numbers::pi, .pivot_distance_m = 7.0},
                       Standing(200.0));
  const Eigen::Matrix3d body = path.WorldFromObject(alignment, 0).linear();
  const double yaw_rad = 200.0 / 350.0 + std::asin(3.5 / 350.0);
  EXPECT_NEAR(body(0, 0), -std::cos(yaw_rad), 1e-11);
  EXPECT_NEAR(body(1, 0), -std::sin(yaw_rad), 1e-11);
  EXPECT_NEAR(body(2, 2), 1.0, 1e-12);
}

TEST(TrackPath, LeansABodyByTheMeanOfTheCantsAndPitchesItAlongTheGradient) {
  const Alignment alignment = Arc();
  const TrackPath path(Axis(), {.pivot_distance_m = 10.0}, Standing(200.0));
  const Eigen::Matrix3d body = path.WorldFromObject(alignment, 0).linear();
  const Eigen::Matrix3d middle = alignment.WorldFromTrack(195.0).linear();
  // In an arc of constant cant and gradient, the body has the axes of the track between its pivots,
  // except that its chord is shorter than the arc by (L / 2R)^2 / 6, here 26 ppm, for the gradient.
  EXPECT_TRUE(body.isApprox(middle, 1e-5));
  EXPECT_TRUE((body.transpose() * body).isApprox(Eigen::Matrix3d::Identity(), 1e-12));
}

// A body of length L on pivots a apart in an arc of radius R lies along a chord: its middle is
// sqrt(R^2 - a^2 / 4) from the arc's centre, inwards of the track, and its ends
// sqrt(R^2 - a^2 / 4 + L^2 / 4), outwards of it.
TEST(TrackPath, ThrowsTheMiddleOfABodyInwardsAndItsEndsOutwards) {
  const Alignment alignment = LevelArc();
  constexpr double kLength_m = 26.4;
  constexpr double kPivots_m = 19.0;
  const Vector3 centre(0.0, 350.0, 0.0);
  for (const double d_m : {0.0, -4.0, 4.5}) {
    for (const double heading_rad : {0.0, std::numbers::pi}) {
      const TrackPath path(Axis(),
                           {.d_m = d_m,
                            .heading_rad = heading_rad,
                            .pivot_distance_m = kPivots_m,
                            .is_midway = true},
                           Standing(200.0));
      const Transform world_from_body = path.WorldFromObject(alignment, 0);
      const double radius_m = 350.0 - d_m;
      const double middle_m = std::sqrt(radius_m * radius_m - kPivots_m * kPivots_m / 4.0);
      EXPECT_NEAR((world_from_body.translation() - centre).norm(), middle_m, 1e-9);
      EXPECT_NEAR(radius_m - middle_m, kPivots_m * kPivots_m / (8.0 * radius_m), 1e-4);
      for (const double end : {-0.5, 0.5}) {
        const Vector3 at_end = world_from_body * Vector3(end * kLength_m, 0.0, 0.0);
        EXPECT_NEAR((at_end - centre).norm(), std::hypot(middle_m, kLength_m / 2.0), 1e-9);
      }
      // It stands symmetrically about its chainage, and faces as it should.
      const double yaw_rad = 200.0 / 350.0 + heading_rad;
      EXPECT_NEAR(world_from_body.linear()(0, 0), std::cos(yaw_rad), 1e-9);
      EXPECT_NEAR(world_from_body.linear()(1, 0), std::sin(yaw_rad), 1e-9);
    }
  }
}

// The tangent at the end of a chord of length a is turned from it by asin(a / 2R).
TEST(TrackPath, TurnsTheBogiesIntoTheTrackBelowThem) {
  const Alignment alignment = LevelArc();
  const double turn_rad = std::asin(7.1 / 350.0);
  for (const double heading_rad : {0.0, std::numbers::pi}) {
    const TrackPath path(Axis(),
                         {.heading_rad = heading_rad, .pivot_distance_m = 14.2, .is_midway = true},
                         Standing(200.0));
    const auto [body, front, rear] = path.WorldFromVehicleAt(alignment, 200.0);
    EXPECT_TRUE(body.isApprox(path.WorldFromObject(alignment, 0), 1e-15));
    EXPECT_TRUE(front.translation().isApprox(body * Vector3(7.1, 0, 0), 1e-12));
    EXPECT_TRUE(rear.translation().isApprox(body * Vector3(-7.1, 0, 0), 1e-12));
    // The arc turns left: ahead of a body that runs with the chainage, it has turned further.
    const double side = heading_rad == 0.0 ? 1.0 : -1.0;
    const Eigen::Matrix3d body_from_front = body.linear().transpose() * front.linear();
    const Eigen::Matrix3d body_from_rear = body.linear().transpose() * rear.linear();
    EXPECT_NEAR(std::asin(body_from_front(1, 0)), side * turn_rad, 1e-9);
    EXPECT_NEAR(std::asin(body_from_rear(1, 0)), -side * turn_rad, 1e-9);
  }
}

// Where the cant changes, each bogie has that of its own place, and the body the mean of both.
TEST(TrackPath, TwistsTheBogiesWhereTheCantChanges) {
  AlignmentSpec spec = AlignmentOf({{ElementType::kStraight, 1000.0, {}}});
  spec.cants_mm = {{0.0, 0.0}, {400.0, 0.0}, {440.0, 100.0}};
  const Alignment alignment(spec);
  const TrackPath path(Axis(), {.pivot_distance_m = 10.0, .is_midway = true}, Standing(420.0));
  const auto roll_rad = [](const Transform& pose) { return std::asin(pose.linear()(2, 1)); };
  const auto [body, front, rear] = path.WorldFromVehicleAt(alignment, 420.0);
  EXPECT_NEAR(roll_rad(front), roll_rad(alignment.WorldFromTrack(425.0)), 1e-12);
  EXPECT_NEAR(roll_rad(rear), roll_rad(alignment.WorldFromTrack(415.0)), 1e-12);
  EXPECT_NEAR(std::abs(roll_rad(front) - roll_rad(rear)), 0.025 / 1.5, 1e-4);
  EXPECT_NEAR(roll_rad(body), 0.5 * (roll_rad(front) + roll_rad(rear)), 1e-6);
}

TEST(TrackPath, TurnsABodyAgainstItsTrackAboutItsMiddle) {
  const Alignment alignment = LevelArc();
  const TrackPose along{.pivot_distance_m = 14.2, .is_midway = true};
  TrackPose turned = along;
  turned.heading_rad = 0.3;
  const Transform body = TrackPath(Axis(), along, Standing(200.0)).WorldFromObject(alignment, 0);
  const Transform derailed =
      TrackPath(Axis(), turned, Standing(200.0)).WorldFromObject(alignment, 0);
  EXPECT_TRUE(derailed.translation().isApprox(body.translation(), 1e-12));
  EXPECT_NEAR((body.linear().transpose() * derailed.linear())(1, 0), std::sin(0.3), 1e-12);
}

TEST(TrackPath, PutsABodyOnTheStraightBeforeTheLine) {
  const TrackPath path(Axis(), {.pivot_distance_m = 10.0}, Standing(0.0));
  EXPECT_TRUE(path.WorldFromObject(LevelArc(), 0).isApprox(LevelArc().WorldFromTrack(0.0), 1e-12));
}

TEST(TrackPath, KeepsUprightThingsUprightAtTheirPlace) {
  const TrackPath path(Axis(), {.d_m = 3.0, .h_m = 0.5, .heading_rad = 0.3, .is_upright = true},
                       Standing(200.0));
  const Alignment alignment = Arc();
  const Transform world_from_object = path.WorldFromObject(alignment, 0);
  EXPECT_TRUE(world_from_object.linear().col(2).isApprox(Vector3::UnitZ(), 1e-12));
  const double heading_rad = 200.0 / 400.0 + 0.3;
  EXPECT_NEAR(world_from_object.linear()(0, 0), std::cos(heading_rad), 1e-12);
  EXPECT_NEAR(world_from_object.linear()(1, 0), std::sin(heading_rad), 1e-12);
  EXPECT_TRUE(world_from_object.translation().isApprox(
      alignment.WorldFromTrack(200.0, 3.0, 0.5).translation(), 1e-12));
}

TEST(TrackPath, TurnsInTheTracksPlane) {
  const TrackPath path(Axis(), {.heading_rad = std::numbers::pi}, Standing(200.0));
  const Alignment alignment = Arc();
  const Eigen::Matrix3d turned = path.WorldFromObject(alignment, 0).linear();
  const Eigen::Matrix3d track = alignment.WorldFromTrack(200.0).linear();
  EXPECT_TRUE(turned.col(0).isApprox(-track.col(0), 1e-12));
  EXPECT_TRUE(turned.col(2).isApprox(track.col(2), 1e-12));
}

TEST(TrackPath, MovesWithItsProfile) {
  const TrackPath path(Axis(), {}, SpeedProfile({{{0.0, std::nullopt, 10.0}}}, 100.0));
  EXPECT_TRUE(path.moves());
  EXPECT_DOUBLE_EQ(path.ChainageAt(2'500'000'000), 125.0);
  const Alignment alignment = Arc();
  EXPECT_TRUE(path.WorldFromObject(alignment, 2'500'000'000)
                  .isApprox(alignment.WorldFromTrack(125.0), 1e-12));
}

}  // namespace
}  // namespace railcast
