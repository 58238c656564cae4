#include "tests/bench/scene_settings.h"

#include <gtest/gtest.h>

#include <set>

#include "generator/check/scene_audit.h"

namespace railcast {
namespace {

constexpr std::size_t kNumObjects = 8;  // Of the demo.

// The demo with a short range, so that few chunks are built.
ScenarioSpec ShortSighted() {
  ScenarioSpec scenario = ReadScenario(RAILCAST_SOURCE_DIR "/scenarios/st_gallen_approach.json");
  scenario.lidar.range_max_m = 60.0;
  return scenario;
}

ScenarioSpec SettingNamed(const std::string& name) {
  for (SceneSetting& setting : SceneSettings(ShortSighted())) {
    if (setting.name == name) return std::move(setting.scenario);
  }
  ADD_FAILURE() << "no setting of the name " << name;
  return {};
}

SceneAudit AuditOf(const std::string& name) {
  const ScenarioSpec scenario = SettingNamed(name);
  const auto world = MakeWorld(scenario);
  return AuditScene(*world, MaterialLibrary(scenario.materials), 0,
                    BuildChunksInReach(*world, 0, scenario.lidar.range_max_m));
}

// Triangles of the placements that `chooses` picks, in all chunks in reach.
template <typename Choice>
std::size_t PlacedTriangles(const std::string& name, const Choice& chooses) {
  const ScenarioSpec scenario = SettingNamed(name);
  const auto world = MakeWorld(scenario);
  std::size_t count = 0;
  for (const int index : world->ChunksInReach(world->HomeChunk(0), scenario.lidar.range_max_m)) {
    for (const Placement& placement : world->BuildChunk(index).placements) {
      if (chooses(placement)) count += placement.model->num_triangles();
    }
  }
  return count;
}

bool IsTree(const Placement& placement) {
  return placement.sway_height_m > 0.0;
}

std::size_t FiringsOnWires(const std::string& name) {
  ScenarioSpec scenario = SettingNamed(name);
  scenario.fidelity = Fidelity::kGeometry;
  const LabelTable labels(scenario.labels);
  const std::set<std::uint32_t> wires = {labels.Find("contact_wire")->id,
                                         labels.Find("messenger_wire")->id,
                                         labels.Find("dropper")->id};
  Frame frame;
  MakeSimulator(scenario, 1)->Scan(0, frame);
  std::size_t count = 0;
  for (const std::uint32_t label : frame.label) count += wires.count(label);
  return count;
}

TEST(SceneSettings, ChangeOneThingOfTheBaseEach) {
  const ScenarioSpec base = SettingNamed("base");
  const auto with = [&](const std::string& name, const auto& restore) {
    ScenarioSpec setting = SettingNamed(name);
    EXPECT_NE(setting, base) << name;
    restore(setting);
    EXPECT_EQ(setting, base) << name;
  };
  with("no foliage",
       [](ScenarioSpec& setting) { setting.world.vegetation.trees_per_hectare = 60; });
  with("grass as geometry", [](ScenarioSpec& setting) { setting.world.vegetation.grass = false; });
  with("contact line off", [](ScenarioSpec& setting) { setting.world.catenary.enabled = true; });
  with("10x objects", [](ScenarioSpec& setting) { setting.world.objects.resize(kNumObjects); });
  with("100x objects", [](ScenarioSpec& setting) { setting.world.objects.resize(kNumObjects); });
  with("camera on", [](ScenarioSpec& setting) { setting.camera.reset(); });
}

TEST(SceneSettings, WithoutFoliageTheSceneHasTheBasesTrianglesWithoutTrees) {
  const std::size_t in_trees = PlacedTriangles("base", IsTree);
  EXPECT_GT(in_trees, 0U);
  EXPECT_EQ(PlacedTriangles("no foliage", IsTree), 0U);
  const SceneAudit base = AuditOf("base");
  const SceneAudit lean = AuditOf("no foliage");
  EXPECT_EQ(lean.placed_triangles, base.placed_triangles - in_trees);
  EXPECT_EQ(lean.ground_triangles, base.ground_triangles);
}

TEST(SceneSettings, GrassAsGeometryAddsPatchesOfBlades) {
  constexpr std::size_t kTrianglesOfAPatch = 640 * 3;
  const SceneAudit base = AuditOf("base");
  const SceneAudit grass = AuditOf("grass as geometry");
  const std::size_t num_patches = grass.num_placements - base.num_placements;
  EXPECT_GT(num_patches, 0U);
  EXPECT_EQ(grass.placed_triangles - base.placed_triangles, num_patches * kTrianglesOfAPatch);
  EXPECT_EQ(grass.ground_triangles, base.ground_triangles);
}

TEST(SceneSettings, WithoutContactLineNoBeamMeetsAWire) {
  EXPECT_GT(FiringsOnWires("base"), 0U);
  EXPECT_EQ(FiringsOnWires("contact line off"), 0U);
}

TEST(SceneSettings, CopiesMultiplyTheObjectsTrianglesAndNothingElse) {
  const SceneAudit base = AuditOf("base");
  for (const std::size_t factor : {10U, 100U}) {
    const std::string name = std::to_string(factor) + "x objects";
    const SceneAudit copied = AuditOf(name);
    EXPECT_EQ(SettingNamed(name).world.objects.size(), factor * kNumObjects);
    // The vehicle's own boxes are an object, too, of one box with 12 triangles.
    constexpr std::size_t kOfTheVehicle = 12;
    EXPECT_EQ(copied.object_triangles - kOfTheVehicle,
              factor * (base.object_triangles - kOfTheVehicle));
    EXPECT_EQ(copied.placed_triangles, base.placed_triangles);
  }
}

}  // namespace
}  // namespace railcast
