#include "generator/check/scene_audit.h"

#include <gtest/gtest.h>

#include <cmath>

#include "core/base/units.h"
#include "core/scene/shapes.h"
#include "tests/support/simple_world.h"

namespace railcast {
namespace {

// Returns a model of `count` triangles of one material.
std::shared_ptr<Model> Triangles(std::size_t count, std::uint16_t material) {
  auto model = std::make_shared<Model>();
  model->parts.push_back({{{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, {}}, material, 1});
  model->parts[0].mesh.triangles.assign(count, {0, 1, 2});
  return model;
}

TEST(AuditScene, CountsWhatIsStoredAndWhatIsSeen) {
  SimpleWorld world;
  world.ground = *Triangles(7, 1);
  const auto tree = Triangles(100, 2);
  const auto mast = Triangles(10, 2);
  world.placements = {{tree}, {tree}, {tree}, {mast}};
  world.AddObject(Triangles(12, 3), Transform::Identity());
  const MaterialLibrary library({{"soil", 0.25}, {"leaf", 0.5}, {"paint", 0.3}, {"glass", 0.02}});

  const SceneAudit audit = AuditScene(world, library, 0, BuildChunksInReach(world, 0, 300.0));
  EXPECT_EQ(audit.num_chunks, 1U);
  EXPECT_EQ(audit.ground_triangles, 7U);
  EXPECT_EQ(audit.num_models, 2U);
  EXPECT_EQ(audit.model_triangles, 110U);
  EXPECT_EQ(audit.num_placements, 4U);
  EXPECT_EQ(audit.placed_triangles, 310U);
  EXPECT_EQ(audit.object_triangles, 12U);
  EXPECT_EQ(audit.materials, (std::set<std::string>{"leaf", "paint", "soil"}));
}

// A square plate of 40 m, 2 m below the vehicle.
Model Plate() {
  return {"plate",
          {{{{{-20, -20, -2}, {20, -20, -2}, {20, 20, -2}, {-20, 20, -2}}, {{0, 1, 2}, {0, 2, 3}}},
            1,
            7}}};
}

std::shared_ptr<const Model> Box(double half_size_m) {
  const Vector3 corner_m = Vector3::Constant(half_size_m);
  return std::make_shared<const Model>(Model{"box", {{MakeBox({-corner_m, corner_m}), 2, 9}}});
}

const MaterialLibrary two_materials({{"soil", 0.25}, {"paint", 0.3}});

TEST(LookAround, SeesTheGroundBelowAndNothingAbove) {
  const auto world = std::make_shared<SimpleWorld>();
  world->ground = Plate();
  // The vehicle stands on a slope; "below" follows the plumb line.
  world->chunk_from_vehicle =
      MakeTransform(RotationFromYawPitchRoll(0.0, -0.1, 0.0), Vector3::Zero());
  const SensorSurroundings around = LookAround(world, two_materials, Vector3(0, 0, 1), 100.0);
  const double height_m = 2.0 + std::cos(0.1);
  // "Below" allows half a degree from straight down; the tolerance is for float32.
  EXPECT_NEAR(around.below->range_m, height_m / std::sin(RadFromDeg(89.5)), 1e-5);
  EXPECT_EQ(around.below->label, 7U);
  EXPECT_EQ(around.nearest->range_m, around.below->range_m);
  EXPECT_FALSE(around.above);
  EXPECT_EQ(around.inside, 0U);
  EXPECT_NEAR(around.position_world.z(), std::cos(0.1), 1e-12);
}

TEST(LookAround, TellsWhatTheSensorIsInside) {
  const auto world = std::make_shared<SimpleWorld>();
  world->ground = Plate();
  world->AddObject(Box(0.5), Transform::Identity());
  world->AddObject(Box(3.0), Transform::Identity());
  const SensorSurroundings around = LookAround(world, two_materials, Vector3(0, 0, 1), 100.0);
  EXPECT_EQ(around.inside, 0U);  // The sensor is between the two boxes.
  EXPECT_EQ(around.below->instance, 1U);
  EXPECT_EQ(LookAround(world, two_materials, Vector3(0, 0.1, 0), 100.0).inside, 1U);
}

}  // namespace
}  // namespace railcast
