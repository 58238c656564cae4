#include "viewer/overlays/overlays.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <numeric>
#include <set>

#include "railcast/frame.h"
#include "tests/viewer/overlays/made_line.h"

namespace railcast {
namespace {

std::set<std::string> LabelsOf(const std::vector<Part>& parts, const ScenarioSpec& scenario) {
  const LabelTable labels(scenario.labels);
  std::set<std::string> names;
  for (const Part& part : parts) names.insert(labels.Find(part.label)->name);
  return names;
}

std::size_t NumTriangles(const std::vector<Part>& parts) {
  return std::accumulate(
      parts.begin(), parts.end(), std::size_t{0},
      [](std::size_t sum, const Part& part) { return sum + part.mesh.triangles.size(); });
}

Eigen::AlignedBox3f PartBoundsOf(const std::vector<Part>& parts,
                                 const std::string& label,
                                 const ScenarioSpec& scenario) {
  const std::uint32_t id = LabelTable(scenario.labels).Id(label);
  Eigen::AlignedBox3f bounds;
  for (const Part& part : parts) {
    if (part.label != id) continue;
    for (const Eigen::Vector3f& vertex : part.mesh.vertices) bounds.extend(vertex);
  }
  return bounds;
}

TEST(StandingScene, HasTheTrackAndTheGroundButNoPlants) {
  const Surroundings surroundings = SurroundingsOf(ScenarioOnLine(Straight(1'000.0), 500.0));
  const StandingScene composition = GatherStandingScene(surroundings, 10);
  EXPECT_THAT(LabelsOf(composition.parts, surroundings.scenario),
              testing::ElementsAre("ballast", "cantilever", "contact_wire", "dropper", "ground",
                                   "mast", "messenger_wire", "rail", "sleeper"));
}

TEST(StandingScene, StandsWhereTheWorldHasIt) {
  AlignmentSpec line = Straight(1'000.0);
  line.origin_m = {700'000.0, 250'000.0, 400.0};
  line.heading_deg = 90.0;
  const Surroundings surroundings = SurroundingsOf(ScenarioOnLine(line, 500.0));
  const StandingScene composition = GatherStandingScene(surroundings, 10);
  // The middle of chunk 10 is at chainage 525 m.
  EXPECT_LT(
      (composition.world_from_home.translation() - Vector3(700'000.0, 250'525.0, 400.0)).norm(),
      1e-6);
  // 60E1 rails have heads of 72 mm beside the gauge of 1435 mm and feet of 150 mm, and end at top
  // of rail.
  const Eigen::AlignedBox3f rails = PartBoundsOf(composition.parts, "rail", surroundings.scenario);
  EXPECT_NEAR(rails.max().z(), 0.0F, 1e-3F);
  EXPECT_NEAR(rails.max().y(), 0.7175F + 0.036F + 0.075F, 0.01F);
  EXPECT_NEAR(rails.min().y(), -rails.max().y(), 1e-3F);
}

TEST(StandingScene, ReachesItsRangeFromBothEndsOfTheChunkAndNotMuchFarther) {
  const Surroundings surroundings = SurroundingsOf(ScenarioOnLine(Straight(1'000.0), 500.0));
  const StandingScene composition = GatherStandingScene(surroundings, 10);
  // The ground reaches half a chunk beyond the range and to the end of the last triangle; triangles
  // of rails are up to a chunk long.
  const Eigen::AlignedBox3f ground =
      PartBoundsOf(composition.parts, "ground", surroundings.scenario);
  EXPECT_GE(ground.max().x(), 175.0F);
  EXPECT_LE(ground.min().x(), -175.0F);
  EXPECT_LE(ground.max().x(), 180.0F);
  const Eigen::AlignedBox3f ballast =
      PartBoundsOf(composition.parts, "ballast", surroundings.scenario);
  EXPECT_NEAR(ballast.max().x(), 75.0F, 0.3F);  // Triangles of ballast are 0.2 m long.
  EXPECT_NEAR(ballast.min().x(), -75.0F, 0.3F);
}

TEST(StandingScene, StaysBelow400ThousandTriangles) {
  const Surroundings surroundings = SurroundingsOf(ReadScenario(
      std::filesystem::path(RAILCAST_SOURCE_DIR) / "scenarios/st_gallen_approach.json"));
  const StandingScene composition =
      GatherStandingScene(surroundings, surroundings.world->HomeChunk(0));
  EXPECT_LT(NumTriangles(composition.parts), 400'000U);
  EXPECT_GT(NumTriangles(composition.parts), 100'000U);
}

TEST(StandingScene, UsesEveryVertexItHas) {
  const Surroundings surroundings = SurroundingsOf(ScenarioOnLine(Straight(1'000.0), 500.0));
  for (const Part& part : GatherStandingScene(surroundings, 10).parts) {
    std::vector<bool> is_used(part.mesh.vertices.size());
    for (const auto& triangle : part.mesh.triangles) {
      for (const std::uint32_t i : triangle) is_used.at(i) = true;
    }
    EXPECT_TRUE(std::ranges::all_of(is_used, [](bool used) { return used; }));
  }
}

ObjectSpec Box(const std::string& name, double s_m) {
  ObjectSpec box;
  box.name = name;
  box.type = ObjectType::kBox;
  box.s_m = s_m;
  box.d_m = 3.0;
  box.h_m = 0.5;
  box.size_m = {4.0, 2.0, 1.0};
  return box;
}

TEST(SceneObjects, AreWhereTheyAreAtTheStampInTheSensorsAxes) {
  ScenarioSpec scenario = ScenarioOnLine(Straight(1'000.0), 500.0);
  scenario.world.objects = {Box("cart", 540.0)};
  scenario.world.objects[0].motion =
      MotionSpec{.profile = {{.time_s = 0.0, .s_m = {}, .speed_mps = 10.0}}};
  const Surroundings surroundings = SurroundingsOf(scenario);
  RecordedFrame recorded = FrameOf(surroundings);
  recorded.frame.stamp_ns = 2'000'000'000;
  const std::vector<Part> parts = GatherSceneObjects(surroundings, recorded);
  const Eigen::AlignedBox3f bounds = PartBoundsOf(parts, "object", scenario);
  const Vector3 sensor(500.0 + scenario.lidar.mount.position_m[0],
                       scenario.lidar.mount.position_m[1], scenario.lidar.mount.position_m[2]);
  // By then it is at 560 m; d and h are those of the middle of its foot.
  const Vector3 low = Vector3(558.0, 2.0, 0.5) - sensor;
  const Vector3 high = Vector3(562.0, 4.0, 1.5) - sensor;
  EXPECT_LT((bounds.min().cast<double>() - low).norm(), 1e-4);
  EXPECT_LT((bounds.max().cast<double>() - high).norm(), 1e-4);
}

TEST(SceneObjects, LeaveOutTheOwnVehicleAndWhatIsFar) {
  ScenarioSpec scenario = ScenarioOnLine(Straight(1'000.0), 500.0);
  scenario.vehicle.ego_boxes_m = {{-18.0, -1.45, 0.3, 2.0, 1.45, 3.9}};
  scenario.world.objects = {Box("near", 640.0), Box("far", 660.0)};
  const Surroundings surroundings = SurroundingsOf(scenario);
  const std::vector<Part> parts = GatherSceneObjects(surroundings, FrameOf(surroundings));
  ASSERT_EQ(parts.size(), 1U);
  EXPECT_EQ(parts[0].mesh.triangles.size(), 12U);
  RecordedFrame without_pose = FrameOf(surroundings);
  without_pose.has_pose = false;
  EXPECT_THAT(GatherSceneObjects(surroundings, without_pose), testing::IsEmpty());
}

}  // namespace
}  // namespace railcast
