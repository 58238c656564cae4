// A scene gives the same frame anywhere in the world.
#include <gtest/gtest.h>

#include <cmath>

#include "tests/support/analytic_meshes.h"
#include "tests/support/scan_once.h"
#include "tests/support/simple_world.h"

namespace railcast {
namespace {

std::shared_ptr<SimpleWorld> Yard(const Transform& world_from_chunk) {
  auto world = std::make_shared<SimpleWorld>();
  world->world_from_chunk = world_from_chunk;
  world->chunk_from_vehicle =
      MakeTransform(RotationFromYawPitchRoll(0.01, 0.002, 0.03), {-12.0, 0.3, 2.5});
  world->velocity_chunk_mps = {11.0, 0.1, 0.0};
  world->ground.parts = {{MakeFloor(-0.5F, 400.0F), 1, 1}};
  const auto ball = std::make_shared<Model>(Model{"ball", {{MakeSphere(1.0, 24, 48), 2, 2}}});
  for (int i = 0; i < 12; ++i) {
    world->AddObject(ball,
                     MakeTransform(Eigen::Matrix3d::Identity(), {10.0 + 20.0 * i, 5.0 - i, 1.0}),
                     i % 3 == 0 ? Vector3(-4.0, 0.5, 0.0) : Vector3::Zero());
  }
  return world;
}

void ExpectSameScan(const Transform& world_from_chunk) {
  const ScanPattern pattern = MakeRaster(60, 30, 0.25);
  const Frame here = ScanOnce(Yard(Transform::Identity()), pattern, {}, 7);
  const Frame there = ScanOnce(Yard(world_from_chunk), pattern, {}, 7);
  double worst_m = 0.0;
  std::size_t num_other_labels = 0;
  for (std::size_t slot = 0; slot < here.num_slots(); ++slot) {
    if (here.label[slot] != there.label[slot]) {
      ++num_other_labels;
      continue;
    }
    if (here.label[slot] == 0) continue;
    worst_m = std::max(worst_m, std::abs(static_cast<double>(here.range_m[slot]) -
                                         static_cast<double>(there.range_m[slot])));
  }
  // The frames differ by the rounding of poses in double: 1 nm at 5.3e6 m.
  EXPECT_LE(worst_m, 2e-4);
  EXPECT_LE(num_other_labels, 1U);
}

TEST(PlacementInvariance, TwentyNineKilometresDownTheLine) {
  ExpectSameScan(MakeTransform(RotationFromYawPitchRoll(1.1, 0, 0), {29'000.0, -3'000.0, 650.0}));
}

TEST(PlacementInvariance, AtUtmCoordinates) {
  ExpectSameScan(MakeTransform(RotationFromYawPitchRoll(-2.3, 0, 0), {5.3e6, 6e5, 400.0}));
}

}  // namespace
}  // namespace railcast
