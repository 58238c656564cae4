#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "core/io/recording/recorded_motion.h"
#include "core/io/write_file.h"
#include "generator/extras/insert/run/insert_run.h"
#include "railcast/io/recording.h"
#include "tests/core/io/message_of.h"
#include "tests/core/io/recording/made_sequence.h"
#include "tests/core/io/recording/read_all.h"
#include "tests/core/io/temporary_directory.h"
#include "tests/generator/extras/insert/run/made_insertion.h"

namespace railcast {
namespace {

namespace fs = std::filesystem;

constexpr double kRangeNoise_m = 0.15;  ///< Seven standard deviations of 0.02 m.

/// A crate put into the last two of four clouds that have neither labels nor poses.
class InsertionIntoClouds : public testing::TestWithParam<const char*> {
 protected:
  void SetUp() override {
    MadeSequenceSpec made = RunWith("pcd", "");
    made.fields = "x,y,z,intensity,time_ns,ring,column";
    made.num_frames = 4;
    run_ = MakeSequence(Path("run"), made);
    fs::copy(Path("run/frames"), Path("clouds"));
    const std::string line = R"({"poses_file": "run/poses.csv", )" + std::string(kSameLine + 1);
    Insert("clouds", WriteRunPlan(folder_.path(), kBox, line), "out", GetParam(), 2);
  }

  [[nodiscard]] fs::path Path(const std::string& name) const { return folder_.path() / name; }
  /// Into two frames.
  void Insert(const std::string& recording,
              const fs::path& plan,
              const std::string& out,
              const std::string& format,
              std::uint32_t first) const {
    const InsertChoices choices = {.recording = Path(recording),
                                   .plan = {},
                                   .directory = Path(out),
                                   .format = format,
                                   .first_frame = first,
                                   .last_frame = first + 1};
    (void)RunInsert(choices, ReadInsertPlan(plan, Path(recording)),
                    {[](std::uint32_t, std::uint32_t) {}, [] { return false; }});
  }

  TemporaryDirectory folder_;
  MadeSequence run_;
};

TEST_P(InsertionIntoClouds, HasTheBoxesWithTheirPointsAndLabels) {
  for (const char* const name : {"out", "out/recording"}) {
    const auto recording = OpenRecording(Path(name));
    EXPECT_EQ(recording->info().num_frames, 2U);
    for (const RecordedFrame& recorded : ReadAll(*recording)) {
      ASSERT_EQ(recorded.objects.size(), 1U);
      const RecordedObject& crate = recorded.objects[0];
      EXPECT_EQ(crate.name, "crate");
      const Label* const label = recording->info().labels.Find(crate.label);
      ASSERT_NE(label, nullptr) << crate.label;
      const RecordedMotion motion(recorded, Compensation::kAll);
      const Transform box_from_sensor = motion.BoxOf(crate).inverse();
      std::uint32_t num_points = 0;
      const Frame& frame = recorded.frame;
      for (std::size_t slot = 0; slot < frame.num_slots(); ++slot) {
        if (std::isnan(frame.x[slot]) || frame.instance[slot] != crate.instance) continue;
        ++num_points;
        EXPECT_EQ(frame.label[slot], label->id);
        const Vector3 in_box_m = box_from_sensor * motion.PointOf(slot).cast<double>();
        EXPECT_LT((in_box_m.cwiseAbs() - 0.5 * crate.size_m).maxCoeff(), kRangeNoise_m);
      }
      EXPECT_EQ(num_points, crate.points);
      EXPECT_GT(num_points, 50U);
    }
  }
}

TEST_P(InsertionIntoClouds, HasTheNumbersTimesAndPosesOfItsFrames) {
  const std::vector<RecordedFrame> frames = ReadAll(Path("out"));
  ASSERT_EQ(frames.size(), 2U);
  for (std::size_t i = 0; i < frames.size(); ++i) {
    const Frame& got = frames[i].frame;
    const Frame& expected = run_.frames[i + 2];
    EXPECT_EQ(got.index, i + 2);
    EXPECT_EQ(got.stamp_ns, expected.stamp_ns);
    ASSERT_TRUE(frames[i].has_pose);
    EXPECT_TRUE(got.world_from_sensor.isApprox(expected.world_from_sensor, 1e-9));
    // Between the poses of frames 2 m apart in an arc of 500 m, a chord is 1 mm from the arc; the
    // motion after the last pose goes on straight, 4 mm beside it.
    EXPECT_EQ(got.duration_ns, expected.duration_ns);
    const Vector3 apart_m =
        got.world_from_sensor_end.translation() - expected.world_from_sensor_end.translation();
    EXPECT_LT(apart_m.norm(), 0.01);
  }
}

TEST_P(InsertionIntoClouds, IsAScenarioOnItsLine) {
  const auto scenario = OpenRecording(Path("out"))->info().scenario;
  ASSERT_TRUE(scenario.has_value());
  EXPECT_FALSE(scenario->world.recording.has_value());
  EXPECT_EQ(scenario->lidar.mount, run_.scenario.lidar.mount);
  EXPECT_EQ(scenario->world.alignment, run_.scenario.world.alignment);
}

TEST_P(InsertionIntoClouds, IsCheckedAgainstItsHashes) {
  const std::string objects = ReadFileWhole(Path("out/objects.jsonl"));
  std::string changed = objects;
  changed.replace(changed.find("crate"), 5, "grate");
  WriteFileWhole(Path("out/objects.jsonl"), changed);
  EXPECT_THAT(MessageOf([&] { (void)ReadAll(Path("out")); }),
              testing::StartsWith(Path("out/insert.jsonl").string() +
                                  ":1: records_xxh3: must be that of the frame's lines in "
                                  "poses.csv:2, objects.jsonl:1"));
  WriteFileWhole(Path("out/objects.jsonl"), objects);
  const fs::path rows = Path("out/points/000003.npy");
  WriteFileWhole(rows, ReadFileWhole(rows) + "x");
  EXPECT_THAT(MessageOf([&] { (void)ReadAll(Path("out")); }),
              testing::HasSubstr("points/000003.npy: must have "));
}

TEST_P(InsertionIntoClouds, IsARecordingToPutFurtherThingsInto) {
  if (std::string(GetParam()) == "kitti") GTEST_SKIP() << "a raster's points have no rings";
  std::string second = kBox;
  second.replace(second.find("crate"), 5, "chest");
  const fs::path plan = WriteRunPlan(folder_.path(), second);
  nlohmann::json json = nlohmann::json::parse(ReadFileWhole(plan));
  json.erase("lidar");  // That of the first plan serves.
  WriteFileWhole(plan, json.dump());
  Insert("out", plan, "twice", "pcd", 0);
  const std::vector<RecordedFrame> frames = ReadAll(Path("twice"));
  ASSERT_EQ(frames.size(), 2U);
  ASSERT_EQ(frames[0].objects.size(), 2U);
  EXPECT_EQ(frames[0].objects[0].name, "crate");
  EXPECT_EQ(frames[0].objects[1].name, "chest");
}

INSTANTIATE_TEST_SUITE_P(Formats, InsertionIntoClouds, testing::Values("same", "pcd", "kitti"));

}  // namespace
}  // namespace railcast
