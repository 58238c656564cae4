#include "viewer/frames/frames.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "railcast/io/cloud_files.h"
#include "railcast/scenario.h"
#include "tests/core/io/example_frame.h"
#include "tests/core/io/message_of.h"
#include "tests/core/io/temporary_directory.h"
#include "tests/viewer/made_run.h"
#include "viewer/frames/recorded_frames.h"

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

}  // namespace
}  // namespace railcast
