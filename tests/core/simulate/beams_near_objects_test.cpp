#include "core/simulate/beams_near_objects.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <memory>

#include "tests/support/analytic_meshes.h"
#include "tests/support/scan_once.h"
#include "tests/support/simple_world.h"

namespace railcast {
namespace {

std::shared_ptr<SimpleWorld> WorldWithSphere(const Vector3& place_m, const Vector3& velocity_mps) {
  auto world = std::make_shared<SimpleWorld>();
  const auto model =
      std::make_shared<const Model>(Model{"sphere", {{MakeSphere(1.0, 12, 24), 3, 1}}});
  world->AddObject(model, MakeTransform(Eigen::Matrix3d::Identity(), place_m), velocity_mps);
  return world;
}

TEST(BeamsNearObjects, AreAllThatMeetAMovingObjectAndFewMore) {
  const auto world = WorldWithSphere({25.0, -3.0, 0.0}, {0.0, 30.0, 0.0});
  world->velocity_chunk_mps = {20.0, 0.0, 0.0};
  const ScanPattern pattern = MakeRaster(60.0, 30.0, 0.5);
  const Frame frame = ScanOnce(world, pattern);
  const std::vector<bool> is_near = BeamsNearObjects(
      *world, std::array<std::size_t, 1>{}, pattern,
      {.stamp_ns = 0, .vehicle_from_sensor = Transform::Identity(), .range_max_m = 300.0});
  std::size_t num_hits = 0;
  for (std::uint32_t i = 0; i < pattern.num_firings(); ++i) {
    const std::size_t slot = std::size_t{pattern.row[i]} * pattern.columns + pattern.column[i];
    if (frame.outcome[slot] != Outcome::kReturned) continue;
    ++num_hits;
    EXPECT_TRUE(is_near[i]);
  }
  ASSERT_GT(num_hits, 30U);
  // The sphere around the box around a sphere has the square root of 3 times its radius.
  EXPECT_LT(static_cast<std::size_t>(std::ranges::count(is_near, true)), 5 * num_hits);
}

TEST(BeamsNearObjects, AreNoneBehindTheSensorOrBeyondItsRange) {
  const ScanPattern pattern = MakeRaster(60.0, 30.0, 1.0);
  for (const double ahead_m : {-20.0, 400.0}) {
    const auto world = WorldWithSphere({ahead_m, 0.0, 0.0}, Vector3::Zero());
    const std::vector<bool> is_near = BeamsNearObjects(
        *world, std::array<std::size_t, 1>{}, pattern,
        {.stamp_ns = 0, .vehicle_from_sensor = Transform::Identity(), .range_max_m = 300.0});
    EXPECT_EQ(std::ranges::count(is_near, true), 0);
  }
}

}  // namespace
}  // namespace railcast
