#include "core/motion/gnss.h"

#include <gtest/gtest.h>

#include <memory>
#include <numbers>

#include "tests/support/analytic_meshes.h"
#include "tests/support/scan_once.h"
#include "tests/support/simple_world.h"

namespace railcast {
namespace {

/// A square of 2 km across, turned and moved from x = 0, where it faces -x.
Model Plane(const Transform& to_from_plane) {
  Mesh mesh;
  mesh.Append(MakeWall(0.0F, 1000.0F), to_from_plane);
  return {"plane", {{std::move(mesh), 1, 5}}};
}
Transform Beside(double y_m) {
  return MakeTransform(RotationFromYawPitchRoll(0.5 * std::numbers::pi, 0.0, 0.0), {0.0, y_m, 0.0});
}
Transform Above(double z_m) {
  return MakeTransform(RotationFromYawPitchRoll(0.0, 0.5 * std::numbers::pi, 0.0), {0.0, 0.0, z_m});
}

double ShareAt(std::shared_ptr<const World> world,
               const Vector3& place_m,
               double elevation_mask_rad = 0.0) {
  const SimulatorSpec spec{.detector = {.range_max_m = 100.0}};
  Simulator simulator(std::move(world), MakeRaster(10, 10, 1), TestMaterials(), spec, 1);
  double share = -1.0;
  simulator.VisitScene(0, [&](const SceneOfFrame& scene) {
    share = FreeSkyShare(scene, place_m, elevation_mask_rad, kSkyReach_m);
  });
  return share;
}

// Of rays that are spread evenly, a few lie on either side of any line.
constexpr double kTolerance = 4.0 / 256.0;

TEST(FreeSkyShare, IsOneWhereNothingStands) {
  const auto world = std::make_shared<SimpleWorld>();
  world->ground = Plane(Above(-1.0));
  EXPECT_EQ(ShareAt(world, {0.0, 0.0, 4.0}), 1.0);
}

TEST(FreeSkyShare, IsNoneBelowARoof) {
  const auto world = std::make_shared<SimpleWorld>();
  world->ground = Plane(Above(5.0));
  // Below 0.6 degrees, the roof is farther than 100 m.
  EXPECT_EQ(ShareAt(world, {0.0, 0.0, 4.0}, 0.1), 0.0);
}

TEST(FreeSkyShare, IsHalfBesideAHighWall) {
  const auto world = std::make_shared<SimpleWorld>();
  world->ground = Plane(Beside(1.0));
  EXPECT_NEAR(ShareAt(world, Vector3::Zero()), 0.5, kTolerance);
}

// Solid angle above the elevation e is 2 pi (1 - sin e): a wall beside the antenna up to an
// elevation of 45 degrees all along, 20 m high and 20 m away, hides the half circle's part 1/2 -
// asin(sin 45 deg) / pi of the half sphere, which is 1/4.
TEST(FreeSkyShare, CountsSolidAngle) {
  const auto world = std::make_shared<SimpleWorld>();
  Transform low = Beside(20.0);
  low.translation().z() = 20.0 - 1000.0;
  world->ground = Plane(low);
  // Rays reach 100 m, so that those of directions within 0.2 of the wall's own miss it: 0.04 sr of
  // the half sphere.
  EXPECT_NEAR(ShareAt(world, Vector3::Zero()), 0.75, kTolerance + 0.01);
}

TEST(FreeSkyShare, DoesNotCountWhatIsBelowTheMask) {
  const auto world = std::make_shared<SimpleWorld>();
  Transform low = Beside(20.0);
  low.translation().z() = 20.0 - 1000.0;
  world->ground = Plane(low);
  EXPECT_EQ(ShareAt(world, Vector3::Zero(), 46.0 / 180.0 * std::numbers::pi), 1.0);
}

TEST(FreeSkyShare, TheVehicleHidesNothing) {
  const auto world = std::make_shared<SimpleWorld>();
  auto box = std::make_shared<Model>(Model{"box", {{MakeSphere(3.0, 8, 8), 1, 6}}});
  world->AddObject(box, Transform::Identity(), Vector3::Zero(), /*is_ego=*/true);
  EXPECT_EQ(ShareAt(world, Vector3::Zero()), 1.0);
  const auto with_roof = std::make_shared<SimpleWorld>(*world);
  with_roof->ground = Plane(Above(10.0));
  EXPECT_EQ(ShareAt(with_roof, Vector3::Zero(), 0.2), 0.0);
}

}  // namespace
}  // namespace railcast
