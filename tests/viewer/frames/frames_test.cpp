#include "viewer/frames/frames.h"

#include <gtest/gtest.h>

#include "railcast/io/cloud_files.h"
#include "railcast/rail_world.h"
#include "railcast/scenario.h"
#include "tests/core/io/example_frame.h"
#include "tests/core/io/message_of.h"
#include "tests/core/io/recording/read_all.h"
#include "tests/core/io/temporary_directory.h"
#include "tests/viewer/made_run.h"
#include "viewer/frames/shown_frame.h"

namespace railcast {
namespace {

namespace fs = std::filesystem;

ScenarioSpec Minimal() {
  return ReadScenario(fs::path(RAILCAST_SOURCE_DIR) / "scenarios" / "minimal.json");
}

TEST(Frames, HaveTheNamesOfAScenarioThatIsGiven) {
  const TemporaryDirectory directory;
  std::string bytes;
  EncodePcd(ExampleFrame(0), FieldSelection("x,y,z,label"), PcdEncoding::kBinary, bytes);
  WriteFileWhole(directory.path() / "a.pcd", bytes);
  RecordedFrames frames(directory.path() / "a.pcd");
  const ScenarioSpec scenario = Minimal();
  frames.UseScenario(scenario);
  EXPECT_EQ(frames.info().labels.labels(), scenario.labels);
  EXPECT_EQ(frames.info().materials.at(0), "none");
  EXPECT_EQ(frames.info().materials.at(1), scenario.materials.at(0).name);
  EXPECT_TRUE(frames.info().scenario);
}

TEST(Frames, TakeTheirOwnScenarioAgain) {
  const TemporaryDirectory directory;
  const fs::path run = directory.path() / "run";
  const MadeSequence made = MakeRun(run);
  RecordedFrames frames(run);
  frames.UseScenario(made.scenario);
  frames.UseScenario(ReadScenario(run / "scenario.resolved.json"));
  EXPECT_EQ(ResolvedScenarioJson(*frames.info().scenario), ResolvedScenarioJson(made.scenario));
  EXPECT_EQ(frames.Get(0)->recorded->objects.at(0).name, "wagon") << "as the sequence says";
}

TEST(Frames, RefuseAScenarioThatIsNotTheirOwn) {
  const TemporaryDirectory directory;
  const fs::path run = directory.path() / "run";
  const MadeSequence made = MakeRun(run);
  RecordedFrames frames(run);
  EXPECT_EQ(
      MessageOf([&] { frames.UseScenario(Minimal()); }),
      run.string() + ": has a scenario of its own: --scenario must be the same or be left out");
  EXPECT_EQ(ResolvedScenarioJson(*frames.info().scenario), ResolvedScenarioJson(made.scenario));
}

TEST(WorldObjects, AreWhereTheirPointsAreSeen) {
  const TemporaryDirectory directory;
  const MadeSequence made = MakeRun(directory.path() / "run", "geometry");
  const auto world = MakeWorld(made.scenario);
  for (RecordedFrame& recorded : ReadAll(directory.path() / "run")) {
    const auto objects = ObjectsAt(*world, LabelTable(made.scenario.labels), recorded.frame);
    ASSERT_EQ(objects.size(), 1U);
    EXPECT_EQ(objects[0].name, "crate");
    EXPECT_EQ(objects[0].type, "box");
    EXPECT_EQ(objects[0].label, "wagon");
    // The mesh is stored in float32.
    EXPECT_TRUE(objects[0].size_m.isApprox(Vector3(2, 3, 4), 1e-6));
    const ShownFrame shown = MakeShownFrame(std::move(recorded));
    std::size_t num_points = 0;
    for (std::size_t i = 0; i < shown.num_points(); ++i) {
      if (shown.frame().instance[shown.slots[i]] != objects[0].instance) continue;
      ++num_points;
      const Eigen::Map<const Eigen::Vector3f> point_m(&shown.positions_m[3 * i]);
      const Vector3 in_box_m = objects[0].sensor_from_box.inverse() * point_m.cast<double>();
      // The point is on a face, within the 1 mm that the vehicle's path bends during the scan.
      constexpr double kMotionTolerance_m = 1.2e-3;
      const Vector3 beyond_m = in_box_m.cwiseAbs() - Vector3(1.0, 1.5, 2.0);
      EXPECT_NEAR(beyond_m.maxCoeff(), 0.0, kMotionTolerance_m);
    }
    EXPECT_GT(num_points, 100U);
  }
}

TEST(WorldObjects, HaveTheirVelocities) {
  const TemporaryDirectory directory;
  const MadeSequence made =
      MakeSequence(directory.path() / "run",
                   {.object = R"({"name": "wagon", "type": "open_wagon", "s_m": 300, )"
                              R"("motion": {"profile": [{"time_s": 0, "speed_mps": 30}]}})",
                    .num_frames = 1});
  const auto world = MakeWorld(made.scenario);
  const Frame& frame = made.frames.at(0);
  const auto objects = ObjectsAt(*world, LabelTable(made.scenario.labels), frame);
  ASSERT_EQ(objects.size(), 1U);
  // On bogies up to 10 m apart, the middle of the wagon is 10^2 / 8 / 500 m = 25 mm nearer to the
  // centre of the curve of 500 m radius, and slower by as much in 500 m.
  EXPECT_NEAR(objects[0].velocity_world_mps.norm(), 30.0, 30.0 * 0.025 / 500.0);
  const Vector3 forward = (frame.world_from_sensor * objects[0].sensor_from_box).linear().col(0);
  EXPECT_GT(objects[0].velocity_world_mps.normalized().dot(forward), 0.999);
}

}  // namespace
}  // namespace railcast
