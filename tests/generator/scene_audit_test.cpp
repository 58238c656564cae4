#include "generator/scene_audit.h"

#include <gtest/gtest.h>

#include "tests/support/simple_world.h"

namespace railcast {
namespace {

// So many triangles of a material.
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

  const SceneAudit audit = AuditScene(world, library, 0, 300.0);
  EXPECT_EQ(audit.num_chunks, 1U);
  EXPECT_EQ(audit.ground_triangles, 7U);
  EXPECT_EQ(audit.num_models, 2U);
  EXPECT_EQ(audit.model_triangles, 110U);
  EXPECT_EQ(audit.num_placements, 4U);
  EXPECT_EQ(audit.placed_triangles, 310U);
  EXPECT_EQ(audit.object_triangles, 12U);
  EXPECT_EQ(audit.materials, (std::set<std::string>{"leaf", "paint", "soil"}));
}

}  // namespace
}  // namespace railcast
