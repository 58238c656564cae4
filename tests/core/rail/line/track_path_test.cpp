#include "core/rail/line/track_path.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

namespace railcast {
namespace {

/// A canted arc to the left with a rising gradient.
Alignment Arc() {
  AlignmentSpec spec;
  spec.course = AlignmentElementsSpec{{{ElementType::kArc, 500.0, 400.0}}};
  spec.gradients_permil = {{0.0, 20.0}};
  spec.speed_limits_kmph = {{0.0, 80.0}};
  return Alignment(spec);
}

SpeedProfile Standing(double s_m) {
  return {{}, s_m};
}

TEST(TrackPath, FollowsGradientCurvatureAndCant) {
  const TrackPath path({.d_m = 1.0, .h_m = 0.5}, Standing(200.0));
  const Alignment alignment = Arc();
  EXPECT_FALSE(path.moves());
  const Transform world_from_object = path.WorldFromObject(alignment, 0);
  EXPECT_TRUE(world_from_object.isApprox(alignment.WorldFromTrack(200.0, 1.0, 0.5), 1e-12));
  // It follows the gradient and leans to the left.
  EXPECT_NEAR(world_from_object.linear()(2, 0), std::sin(std::atan(0.02)), 1e-12);
  EXPECT_LT(world_from_object.linear()(2, 1), -0.08);
}

TEST(TrackPath, KeepsUprightThingsUprightAtTheirPlace) {
  const TrackPath path({.d_m = 3.0, .h_m = 0.5, .heading_rad = 0.3, .is_upright = true},
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
  const TrackPath path({.heading_rad = std::numbers::pi}, Standing(200.0));
  const Alignment alignment = Arc();
  const Eigen::Matrix3d turned = path.WorldFromObject(alignment, 0).linear();
  const Eigen::Matrix3d track = alignment.WorldFromTrack(200.0).linear();
  EXPECT_TRUE(turned.col(0).isApprox(-track.col(0), 1e-12));
  EXPECT_TRUE(turned.col(2).isApprox(track.col(2), 1e-12));
}

TEST(TrackPath, MovesWithItsProfile) {
  const TrackPath path({}, SpeedProfile({{{0.0, std::nullopt, 10.0}}}, 100.0));
  EXPECT_TRUE(path.moves());
  EXPECT_DOUBLE_EQ(path.ChainageAt(2'500'000'000), 125.0);
  const Alignment alignment = Arc();
  EXPECT_TRUE(path.WorldFromObject(alignment, 2'500'000'000)
                  .isApprox(alignment.WorldFromTrack(125.0), 1e-12));
}

}  // namespace
}  // namespace railcast
