#include <gtest/gtest.h>

#include <cmath>
#include <memory>

#include "core/base/units.h"
#include "core/scene/shapes.h"
#include "generator/check/scene_audit.h"
#include "railcast/scenario.h"
#include "tests/core/io/temporary_directory.h"
#include "tests/generator/project_folder.h"
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

const MaterialLibrary kTwoMaterials({{"soil", 0.25}, {"paint", 0.3}});

TEST(LookAround, SeesTheGroundBelowAndNothingAbove) {
  const auto world = std::make_shared<SimpleWorld>();
  world->ground = Plate();
  // The vehicle stands on a slope; "below" follows the plumb line.
  world->chunk_from_vehicle =
      MakeTransform(RotationFromYawPitchRoll(0.0, -0.1, 0.0), Vector3::Zero());
  const SensorSurroundings around = LookAround(world, kTwoMaterials, Vector3(0, 0, 1), 100.0);
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
  const SensorSurroundings around = LookAround(world, kTwoMaterials, Vector3(0, 0, 1), 100.0);
  EXPECT_EQ(around.inside, 0U);  // The sensor is between the two boxes.
  EXPECT_EQ(around.below->instance, 1U);
  EXPECT_EQ(LookAround(world, kTwoMaterials, Vector3(0, 0.1, 0), 100.0).inside, 1U);
}

// Ten frames a second.
ScanPattern TenAPerSecond() {
  return BuildScanPattern({10.0, RasterSpec{10.0, 10.0, 5.0, RasterOrder::kColumns}});
}

std::shared_ptr<const Model> CubeOfOneMetre() {
  const Vector3 corner_m = Vector3::Constant(0.5);
  return std::make_shared<const Model>(Model{"cube", {{MakeBox({-corner_m, corner_m}), 1, 9}}});
}

Transform Place(double x_m, double y_m) {
  return MakeTransform(Eigen::Matrix3d::Identity(), {x_m, y_m, 0.0});
}

constexpr double kExactGap_m = 1e-5;

TEST(ContactRuns, SayWhenAMovingObjectMeetsAStandingOneAndLeavesIt) {
  // The centres are 6 - 0.2 k metres apart in frame k, so the cubes meet in frame 25 and part after
  // frame 35. They are 0.3 m aside: the shortest way out is aside, of 0.7 m, once they are at least
  // as deep lengthwise, from frame 29 on.
  SimpleWorld world;
  world.AddObject(CubeOfOneMetre(), Place(6.0, 0.0), Vector3(-2.0, 0.0, 0.0));
  world.AddObject(CubeOfOneMetre(), Place(0.0, 0.3));
  const std::vector<ContactRun> runs = FindContactRuns(world, TenAPerSecond(), 100);
  ASSERT_EQ(runs.size(), 1U);
  EXPECT_EQ(runs[0].first_frame, 25U);
  EXPECT_EQ(runs[0].last_frame, 35U);
  EXPECT_EQ(runs[0].nearest_frame, 29U);
  EXPECT_NEAR(runs[0].nearest.gap_m, -0.7, kExactGap_m);
}

TEST(ContactRuns, EndWithTheLastFrame) {
  SimpleWorld world;
  world.AddObject(CubeOfOneMetre(), Place(6.0, 0.0), Vector3(-2.0, 0.0, 0.0));
  world.AddObject(CubeOfOneMetre(), Place(0.0, 0.3));
  const std::vector<ContactRun> runs = FindContactRuns(world, TenAPerSecond(), 26);
  ASSERT_EQ(runs.size(), 1U);
  EXPECT_EQ(runs[0].last_frame, 26U);
  EXPECT_TRUE(FindContactRuns(world, TenAPerSecond(), 24).empty());
}

TEST(ContactRuns, OfWhatStandsLastForAllFrames) {
  SimpleWorld world;
  world.AddObject(CubeOfOneMetre(), Place(1.01, 0.0));
  world.AddObject(CubeOfOneMetre(), Place(0.0, 0.3));
  const std::vector<ContactRun> runs = FindContactRuns(world, TenAPerSecond(), 4'000'000'000U);
  ASSERT_EQ(runs.size(), 1U);
  EXPECT_EQ(runs[0].first_frame, 0U);
  EXPECT_EQ(runs[0].last_frame, 4'000'000'000U);
  EXPECT_FALSE(runs[0].nearest.is_overlap());
}

TEST(ContactRuns, AreOnePairEachTimeThatTheyMeet) {
  // Three cubes run one after another past a fourth, 1 m apart: they need 2 m past it.
  SimpleWorld world;
  world.AddObject(CubeOfOneMetre(), Place(0.0, 0.3));
  for (const double x_m : {4.0, 7.0}) {
    world.AddObject(CubeOfOneMetre(), Place(x_m, 0.0), Vector3(-2.0, 0.0, 0.0));
  }
  const std::vector<ContactRun> runs = FindContactRuns(world, TenAPerSecond(), 100);
  ASSERT_EQ(runs.size(), 2U);
  EXPECT_EQ(runs[0].nearest.other, 1U);
  EXPECT_EQ(runs[0].first_frame, 15U);
  EXPECT_EQ(runs[1].nearest.other, 2U);
  EXPECT_EQ(runs[1].first_frame, 30U);
}

// Two boxes of 14 x 2 x 3 m on an arc of 200 m radius to the left, each along its tangent, their
// middles `apart_m` of chainage apart. On the bisector between them, the inner end corners come
// nearest: 2 ((R - 1) sin(a) - 7 cos(a)), where a is half the angle between them.
double GapInCurve_m(double apart_m) {
  const double half_rad = 0.5 * apart_m / 200.0;
  return 2.0 * (199.0 * std::sin(half_rad) - 7.0 * std::cos(half_rad));
}

std::vector<ContactRun> RunsInCurve(double apart_m) {
  const TemporaryDirectory directory;
  ScenarioSpec scenario = ReadScenario(MakeProject(directory.path()));
  scenario.world.alignment.course =
      AlignmentElementsSpec{{{.type = ElementType::kArc, .length_m = 400.0, .radius_m = 200.0}}};
  scenario.world.objects.clear();
  for (const double s_m : {100.0, 100.0 + apart_m}) {
    ObjectSpec box;
    box.name = "box " + std::to_string(s_m);
    box.type = ObjectType::kBox;
    box.s_m = s_m;
    box.h_m = 1.0;
    box.size_m = {14.0, 2.0, 3.0};
    scenario.world.objects.push_back(box);
  }
  scenario.vehicle.start_s_m = 10.0;
  return FindContactRuns(*MakeWorld(scenario), TenAPerSecond(), 0);
}

TEST(ContactRuns, KnowTheInnerCornersOfWhatStandsInACurve) {
  constexpr double kTouching_m = 14.08;
  ASSERT_GT(GapInCurve_m(kTouching_m), 0.005);
  const std::vector<ContactRun> touching = RunsInCurve(kTouching_m);
  ASSERT_EQ(touching.size(), 1U);
  EXPECT_NEAR(touching[0].nearest.gap_m, GapInCurve_m(kTouching_m), kExactGap_m);
  EXPECT_TRUE(RunsInCurve(kTouching_m + 0.02).empty());
  // Coupled as on the straight, they are in each other: the corner leaves by the end face, which is
  // turned by the whole angle, and is thus a little less deep than along the bisector.
  const std::vector<ContactRun> coupled = RunsInCurve(14.0);
  ASSERT_EQ(coupled.size(), 1U);
  EXPECT_TRUE(coupled[0].nearest.is_overlap());
  EXPECT_NEAR(coupled[0].nearest.gap_m, GapInCurve_m(14.0), 5e-4);
}

}  // namespace

}  // namespace railcast
