#include "core/simulate/detail_choice.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <memory>
#include <numbers>
#include <vector>

#include "core/base/units.h"
#include "tests/support/simple_world.h"

namespace railcast {
namespace {

DetailRule Rays() {
  return {.vehicle_from_sensor = Transform::Identity(), .ray_spacing_rad = 0.004};
}

DetailRule Beams() {
  DetailRule rule = Rays();
  rule.beam_width_rad = 0.002;
  return rule;
}

/// 2 x 2 m wide and 4 m high, with two coarser forms: where rays are 0.04 m apart, and where they
/// are 0.08 m apart and beams 0.1 m wide.
Placement TestTree() {
  Model tree{"tree", {{{}, 1, 1}}};
  tree.parts[0].mesh.vertices = {{-1, -1, 0}, {1, 1, 4}, {1, -1, 0}};
  tree.parts[0].mesh.triangles = {{0, 1, 2}};
  const auto bare = std::make_shared<const Model>(Model{"bare", {{{}, 1, 1}}});
  const std::vector<CoarserModel> coarser = {{bare, 0.04, 0.0}, {bare, 0.08, 0.1}};
  return {.model = std::make_shared<const Model>(std::move(tree)),
          .coarser = std::make_shared<const std::vector<CoarserModel>>(coarser)};
}

/// A vehicle that moves along x from 0 to 50 m.
SimpleWorld TestWay() {
  SimpleWorld world;
  for (int x_m = 0; x_m <= 50; ++x_m) {
    world.vehicle_poses.push_back(MakeTransform(Eigen::Matrix3d::Identity(), Vector3(x_m, 0, 0)));
  }
  return world;
}

/// The level of the tree with its foot at a place, `scale` times as large.
std::size_t LevelAt(const DetailRule& rule, const Vector3& at_m, double scale = 1.0) {
  DetailChoice choice(TestWay(), 0, rule);
  return choice.LevelOf(TestTree(),
                        Eigen::Affine3d(Eigen::Translation3d(at_m) * Eigen::Scaling(scale)));
}

TEST(DetailChoice, TakesTheCoarsestModelThatTheSpacingOfTheRaysPermits) {
  // Rays are 0.04 m apart at 10 m and 0.08 m at 20 m; the tree begins 1 m before its foot.
  EXPECT_EQ(LevelAt(Rays(), {25, 10.9, 0}), 0U);
  EXPECT_EQ(LevelAt(Rays(), {25, 11.1, 0}), 1U);
  EXPECT_EQ(LevelAt(Rays(), {25, -20.9, 0}), 1U);
  EXPECT_EQ(LevelAt(Rays(), {25, -21.1, 0}), 2U);
}

TEST(DetailChoice, CountsTheLeastDistanceFromAnyPlaceInTheHomeChunk) {
  EXPECT_EQ(LevelAt(Rays(), {0, 5, 0}), 0U);
  EXPECT_EQ(LevelAt(Rays(), {50, 5, 0}), 0U);
  EXPECT_EQ(LevelAt(Rays(), {60.9, 0, 0}), 0U);
  EXPECT_EQ(LevelAt(Rays(), {61.1, 0, 0}), 1U);
  EXPECT_EQ(LevelAt(Rays(), {-11.1, 0, 0}), 1U);
  DetailRule ahead = Rays();
  ahead.vehicle_from_sensor = MakeTransform(Eigen::Matrix3d::Identity(), Vector3(2, 0, 0));
  EXPECT_EQ(LevelAt(ahead, {61.1, 0, 0}), 0U);
}

TEST(DetailChoice, TakesTheWidthOfBeamsIntoAccountWhereTheyHaveOne) {
  // Beams are 0.1 m wide at 50 m.
  EXPECT_EQ(LevelAt(Beams(), {25, 11.1, 0}), 1U);
  EXPECT_EQ(LevelAt(Beams(), {25, 50.9, 0}), 1U);
  EXPECT_EQ(LevelAt(Beams(), {25, 51.1, 0}), 2U);
}

TEST(DetailChoice, LeavesLargerModelsInDetailFartherAway) {
  EXPECT_EQ(LevelAt(Rays(), {25, 21.9, 0}, 2.0), 0U);
  EXPECT_EQ(LevelAt(Rays(), {25, 22.1, 0}, 2.0), 1U);
}

TEST(DetailChoice, IsInFullDetailWhereNothingElseIsKnown) {
  EXPECT_EQ(LevelAt({}, {25, 1000, 0}), 0U);
  Placement alone = TestTree();
  alone.coarser = nullptr;
  EXPECT_EQ(DetailChoice(TestWay(), 0, Rays()).LevelOf(alone, Eigen::Affine3d::Identity()), 0U);
  DetailChoice without_poses(SimpleWorld{}, 0, Rays());
  EXPECT_EQ(
      without_poses.LevelOf(TestTree(), Eigen::Affine3d(Eigen::Translation3d(25.0, 1000.0, 0.0))),
      0U);
}

/// 50 m long about its origin, for rays 0.04 m apart and beams 0.1 m wide, seen within 45 degrees
/// of its x axis.
constexpr double kHalfLength_m = 25.0;
CoarserSurfaces TestSurface() {
  return {.area_m = {Eigen::Vector2d(-kHalfLength_m, -80.0), Eigen::Vector2d(kHalfLength_m, 80.0)},
          .ray_spacing_m = 0.04,
          .beam_width_m = 0.1,
          .sight_angle_rad = RadFromDeg(45.0)};
}

/// With a second form for rays 0.08 m apart.
std::size_t SurfaceLevelAt(const DetailRule& rule,
                           double x_m,
                           double y_m = 0.0,
                           double yaw_deg = 0.0) {
  std::vector<CoarserSurfaces> forms(2, TestSurface());
  forms[1].ray_spacing_m = 0.08;
  return DetailChoice(TestWay(), 0, rule)
      .LevelOf(forms, MakeTransform(RotationFromYawPitchRoll(RadFromDeg(yaw_deg), 0.0, 0.0),
                                    Vector3(x_m, y_m, 30.0)));
}

bool TakesSurfaceAt(const DetailRule& rule, double x_m, double y_m = 0.0, double yaw_deg = 0.0) {
  return SurfaceLevelAt(rule, x_m, y_m, yaw_deg) > 0;
}

TEST(DetailChoice, TakesTheCoarserFormOfAChunkByItsNearestPointInPlan) {
  // Rays are 0.04 m apart at 10 m, whatever the difference in height.
  EXPECT_FALSE(TakesSurfaceAt(Rays(), 50.0 + kHalfLength_m + 9.9));
  EXPECT_TRUE(TakesSurfaceAt(Rays(), 50.0 + kHalfLength_m + 10.1));
  EXPECT_FALSE(TakesSurfaceAt(Rays(), -kHalfLength_m - 9.9));
  EXPECT_TRUE(TakesSurfaceAt(Rays(), -kHalfLength_m - 10.1));
  // Beams are 0.1 m wide at 50 m.
  EXPECT_FALSE(TakesSurfaceAt(Beams(), 50.0 + kHalfLength_m + 49.9));
  EXPECT_TRUE(TakesSurfaceAt(Beams(), 50.0 + kHalfLength_m + 50.1));
}

TEST(DetailChoice, TakesTheCoarserFormOnlyOfChunksThatAreSeenAlongTheTrack) {
  EXPECT_TRUE(TakesSurfaceAt(Rays(), 200.0, 149.0));
  EXPECT_FALSE(TakesSurfaceAt(Rays(), 200.0, 151.0));
  EXPECT_TRUE(TakesSurfaceAt(Rays(), 200.0, 151.0, 20.0));
  EXPECT_FALSE(TakesSurfaceAt(Rays(), 400.0, 0.0, 90.0));
  EXPECT_FALSE(TakesSurfaceAt({}, 1000.0));
  EXPECT_EQ(DetailChoice(SimpleWorld{}, 0, Rays())
                .LevelOf(std::vector{TestSurface()},
                         MakeTransform(Eigen::Matrix3d::Identity(), Vector3(1000.0, 0.0, 0.0))),
            0U);
}

TEST(DetailChoice, TakesTheCoarsestFormOfAChunkThatTheSpacingOfTheRaysPermits) {
  EXPECT_EQ(SurfaceLevelAt(Rays(), 50.0 + kHalfLength_m + 19.9), 1U);
  EXPECT_EQ(SurfaceLevelAt(Rays(), 50.0 + kHalfLength_m + 20.1), 2U);
}

// The chunk is 160 m wide, and the vehicle moves along x from 0 to 50 m.
TEST(DetailChoice, TakesTheCoarsestFormOfAChunkThatNoFiringMeets) {
  DetailRule ahead = Rays();
  ahead.sector.half_width_rad = RadFromDeg(30.0);
  EXPECT_EQ(SurfaceLevelAt(ahead, -kHalfLength_m - 0.1), 2U);
  EXPECT_EQ(SurfaceLevelAt(ahead, -kHalfLength_m + 0.1), 0U);
  EXPECT_EQ(SurfaceLevelAt(ahead, 50.0 + kHalfLength_m), 0U);
  // Seen from x = 0, 30 degrees to the left are 58 m to the left at x = 100 m.
  EXPECT_EQ(SurfaceLevelAt(ahead, 100.0 - kHalfLength_m, 80.0 + 57.0), 0U);
  EXPECT_EQ(SurfaceLevelAt(ahead, 100.0 - kHalfLength_m, 80.0 + 58.0), 2U);
  EXPECT_EQ(SurfaceLevelAt(ahead, 100.0 - kHalfLength_m, -80.0 - 58.0), 2U);
  DetailRule back = ahead;
  back.sector.middle_rad = RadFromDeg(180.0);
  EXPECT_EQ(SurfaceLevelAt(back, 50.0 + kHalfLength_m + 0.1), 2U);
  EXPECT_EQ(SurfaceLevelAt(back, -kHalfLength_m - 0.1), 0U);
}

ScanPattern Raster(double resolution_deg) {
  return BuildScanPattern({.rate_hz = 10.0,
                           .pattern = RasterSpec{.horizontal_fov_deg = 60.0,
                                                 .vertical_fov_deg = 30.0,
                                                 .angular_resolution_deg = resolution_deg}});
}

TEST(SectorOf, HoldsTheFiringsWithAMargin) {
  const ScanSector ahead = SectorOf(Raster(0.25), Transform::Identity());
  EXPECT_NEAR(std::remainder(ahead.middle_rad, 2.0 * std::numbers::pi), 0.0, RadFromDeg(1.0));
  EXPECT_NEAR(DegFromRad(ahead.half_width_rad), 30.0 + 5.0, 1.0);
  const ScanSector left = SectorOf(
      Raster(0.25), MakeTransform(RotationFromYawPitchRoll(RadFromDeg(100.0), RadFromDeg(5.0), 0.0),
                                  Vector3::Zero()));
  EXPECT_NEAR(DegFromRad(std::remainder(left.middle_rad, 2.0 * std::numbers::pi)), 100.0, 1.0);
}

TEST(SectorOf, IsAllAroundForFiringsThatGoSteeplyDown) {
  const ScanSector down = SectorOf(
      Raster(0.25),
      MakeTransform(RotationFromYawPitchRoll(0.0, RadFromDeg(20.0), 0.0), Vector3::Zero()));
  EXPECT_DOUBLE_EQ(down.half_width_rad, std::numbers::pi);
}

TEST(CoarserPoseStep, KeepsTheErrorWithinAnEighthOfWhatTheSensorCanTell) {
  constexpr std::int64_t kStep_ns = 10'000'000;
  // Rays are 0.04 m apart at 10 m: 5 mm is 2.5 times 2 mm.
  EXPECT_NEAR(static_cast<double>(CoarserPoseStep_ns(Rays(), 10.0, kStep_ns)),
              1e7 * std::sqrt(0.005 / 0.002), 1.0);
  // Beams are half as wide.
  EXPECT_NEAR(static_cast<double>(CoarserPoseStep_ns(Beams(), 20.0, kStep_ns)),
              1e7 * std::sqrt(0.005 / 0.002), 1.0);
  EXPECT_EQ(CoarserPoseStep_ns(Rays(), 1.0, kStep_ns), kStep_ns);
  EXPECT_EQ(CoarserPoseStep_ns(Rays(), -1.0, kStep_ns), kStep_ns);
  EXPECT_EQ(CoarserPoseStep_ns({}, 100.0, kStep_ns), kStep_ns);
}

TEST(RaySpacing, IsTheResolutionOfARaster) {
  for (const double resolution_deg : {1.0, 0.25, 0.1}) {
    // A cell of one degree that is not a multiple of the spacing holds one row more or less.
    EXPECT_NEAR(DegFromRad(RaySpacing_rad(Raster(resolution_deg))), resolution_deg,
                0.2 * resolution_deg);
  }
}

TEST(DetailOf, FollowsTheSensorAndTheEffects) {
  const ScanPattern pattern = Raster(0.25);
  SimulatorSpec spec;
  spec.detector.beam.divergence_mrad = {3.0, 1.5};
  EXPECT_DOUBLE_EQ(DetailOf(spec, pattern).ray_spacing_rad, RaySpacing_rad(pattern));
  EXPECT_EQ(DetailOf(spec, pattern).beam_width_rad, 0.0);
  spec.detector.effects.footprint = true;
  EXPECT_DOUBLE_EQ(DetailOf(spec, pattern).beam_width_rad, 1.5e-3);
  spec.detector.effects.dense_footprint = true;  // The yardstick.
  EXPECT_EQ(DetailOf(spec, pattern).ray_spacing_rad, 0.0);
  spec.detector.effects = {};
  spec.has_full_detail = true;
  EXPECT_EQ(DetailOf(spec, pattern).ray_spacing_rad, 0.0);
}

}  // namespace
}  // namespace railcast
