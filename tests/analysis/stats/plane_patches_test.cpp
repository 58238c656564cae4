#include "analysis/stats/plane_patches.h"

#include <gtest/gtest.h>
#include <pcl/common/centroid.h>
#include <pcl/common/eigen.h>
#include <pcl/point_cloud.h>
#include <pcl/point_types.h>

#include <cmath>
#include <memory>

#include "tests/analysis/recorded_frames.h"
#include "tests/support/analytic_meshes.h"
#include "tests/support/scan_once.h"
#include "tests/support/simple_world.h"

namespace railcast {
namespace {

// 5 x 5 beams on a wall, which are one neighbourhood.
Frame ScanFewBeams(double sigma_m) {
  auto world = std::make_shared<SimpleWorld>();
  world->ground.parts = {{MakeWall(20.0F, 10.0F), 2, 1}};
  SimulatorSpec spec{.detector = {.effects = {.threshold = true, .noise = true}}};
  spec.detector.plausibility.noise_sigma0_m = sigma_m;
  spec.detector.plausibility.noise_sigma1 = 0.0;
  return ScanOnce(world, MakeRaster(1.25, 1.25, 0.25), spec);
}

TEST(PlanePatches, HaveTheSpreadThatPclFinds) {
  const RecordedFrame recorded = Record(ScanFewBeams(0.01));
  const auto scan = MakeScanTable(recorded.frame);
  ASSERT_TRUE(scan);
  const auto patches = FindPlanePatches(recorded, &*scan);
  ASSERT_EQ(patches.size(), 1U);
  ASSERT_EQ(patches[0].num_points, 25U);
  pcl::PointCloud<pcl::PointXYZ> cloud;
  for (std::size_t slot = 0; slot < 25; ++slot) {
    cloud.emplace_back(recorded.frame.x[slot], recorded.frame.y[slot], recorded.frame.z[slot]);
  }
  Eigen::Matrix3d spread;
  Eigen::Vector4d middle;
  pcl::computeMeanAndCovarianceMatrix(cloud, spread, middle);
  double smallest = 0.0;
  Eigen::Vector3d normal;
  pcl::eigen33(spread, smallest, normal);
  EXPECT_NEAR(patches[0].plane_squares_m2 / (25.0 * smallest), 1.0, 1e-4);
  EXPECT_NEAR(patches[0].range_m, 20.0, 0.02);
}

TEST(PlanePatches, AreNotFoundAcrossAnEdge) {
  Frame frame = ScanFewBeams(0.01);
  // Make a step of 2 m at the middle column.
  for (std::size_t slot = 0; slot < 25; ++slot) {
    if (slot % 5 < 2) continue;
    for (auto* field : {&frame.x, &frame.y, &frame.z, &frame.range_m}) (*field)[slot] *= 1.1F;
  }
  const RecordedFrame recorded = Record(std::move(frame));
  const auto scan = MakeScanTable(recorded.frame);
  EXPECT_TRUE(FindPlanePatches(recorded, &*scan).empty());
}

TEST(PlanePatches, LeaveOutWhatLiesFarOff) {
  Frame frame = ScanFewBeams(0.01);
  for (auto* field : {&frame.x, &frame.y, &frame.z, &frame.range_m}) (*field)[7] *= 0.8F;
  const RecordedFrame recorded = Record(std::move(frame));
  const auto scan = MakeScanTable(recorded.frame);
  const auto patches = FindPlanePatches(recorded, &*scan);
  ASSERT_EQ(patches.size(), 1U);
  EXPECT_EQ(patches[0].num_outliers, 1U);
  EXPECT_LT(std::sqrt(patches[0].plane_squares_m2 / patches[0].degrees()), 0.02);
}

// Fog in front of a wall and in front of nothing, at a visibility where it hides most beams.
Frame ScanFog(bool has_wall) {
  auto world = std::make_shared<SimpleWorld>();
  if (has_wall) world->ground.parts = {{MakeWall(30.0F, 30.0F), 2, 1}};
  SimulatorSpec spec{.detector = {.effects = EffectsOfRung(Fidelity::kSurface)}};
  spec.detector.effects.channel_bias = false;
  spec.detector.weather.visibility_m = 70.0;
  spec.detector.range_max_m = 100.0;
  return ScanOnce(world, MakeRaster(40.0, 30.0, 0.25), spec);
}

TEST(PlanePatches, AreNoneInFog) {
  const Frame frame = ScanFog(false);
  std::size_t num_fog = 0;
  for (const Outcome outcome : frame.outcome) num_fog += outcome == Outcome::kClutter ? 1 : 0;
  EXPECT_GT(num_fog, frame.num_slots() / 4);
  const RecordedFrame recorded = Record(frame);
  const auto scan = MakeScanTable(MakeRaster(40.0, 30.0, 0.25));
  EXPECT_TRUE(FindPlanePatches(recorded, &*scan).empty());
  // Nor where nothing tells that the points are fog: they scatter too much to be flat.
  EXPECT_TRUE(FindPlanePatches(RecordPointsOnly(frame), &*scan).empty());
}

TEST(PlanePatches, OfAWallBehindFogShowTheNoiseOfTheWall) {
  const Frame frame = ScanFog(true);
  const auto scan = MakeScanTable(MakeRaster(40.0, 30.0, 0.25));
  const auto patches = FindPlanePatches(Record(frame), &*scan);
  double squares_m2 = 0.0;
  double degrees = 0.0;
  for (const PlanePatch& patch : patches) {
    EXPECT_GT(patch.range_m, 29.0);
    squares_m2 += patch.range_squares_m2;
    degrees += patch.degrees();
  }
  ASSERT_GT(patches.size(), 20U);
  // The wall of 50 % is 17 times the threshold at its middle, which gives sigma = hypot(15 mm, 0.1
  // m / sqrt(2 x 85)) = 16.8 mm; at the corners, 33 m away, it is 10 times and 18.1 mm. 20 patches
  // have at least 400 degrees of freedom: four standard errors are 14 %.
  const double sigma_m = std::sqrt(squares_m2 / degrees);
  EXPECT_GT(sigma_m, 0.86 * 0.0168);
  EXPECT_LT(sigma_m, 1.14 * 0.0181);
}

TEST(PlanePatches, AreNoneOnWhatIsMetAlmostEdgeOn) {
  auto world = std::make_shared<SimpleWorld>();
  world->ground.parts = {{MakeFloor(-2.0F, 100.0F), 2, 1}};
  const RecordedFrame recorded = Record(ScanOnce(world, MakeRaster(30.0, 30.0, 0.5)));
  const auto scan = MakeScanTable(recorded.frame);
  // The steepest beam, at 15 deg, meets the ground at an incidence of 75 deg.
  EXPECT_TRUE(FindPlanePatches(recorded, &*scan).empty());
}

}  // namespace
}  // namespace railcast
