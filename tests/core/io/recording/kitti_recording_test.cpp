#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <string>
#include <vector>

#include "core/io/write_file.h"
#include "railcast/io/recording.h"
#include "tests/core/io/message_of.h"
#include "tests/core/io/recording/made_sequence.h"
#include "tests/core/io/recording/read_all.h"
#include "tests/core/io/temporary_directory.h"

namespace railcast {
namespace {

namespace fs = std::filesystem;

/// A cloud of `num_points` points, all with one label, in a folder of KITTI's layout.
void WriteCloud(const fs::path& sequence, const std::string& name, int num_points, char label) {
  fs::create_directories(sequence / "velodyne");
  fs::create_directories(sequence / "labels");
  std::string points;
  std::string labels;
  for (int i = 0; i < num_points; ++i) {
    const std::array<float, 4> point = {3.0F + static_cast<float>(i), 1.0F, 0.5F, 0.25F};
    points.append(reinterpret_cast<const char*>(point.data()), sizeof(point));
    labels += std::string{label, 0, 0, 0};
  }
  WriteFileWhole(sequence / "velodyne" / (name + ".bin"), points);
  WriteFileWhole(sequence / "labels" / (name + ".label"), labels);
}

TEST(KittiRecording, ReadsAllSequencesInTheirNaturalOrder) {
  const TemporaryDirectory directory;
  WriteCloud(directory.path() / "sequences/100", "000000", 2, 30);
  WriteCloud(directory.path() / "sequences/11", "000001", 3, 10);
  WriteCloud(directory.path() / "sequences/11", "000000", 4, 10);
  fs::create_directories(directory.path() / "sequences/02/labels");
  const auto recording = OpenRecording(directory.path());
  EXPECT_EQ(recording->info().kind, "KITTI sequence");
  EXPECT_EQ(recording->info().num_frames, 3U);
  EXPECT_TRUE(recording->info().labels.labels().empty());
  std::vector<std::string> names;
  for (const RecordedFrame& recorded : ReadAll(*recording)) {
    names.push_back(fs::path(recorded.name).lexically_relative(directory.path() / "sequences"));
    EXPECT_EQ(recorded.frame.index + 1, names.size());
  }
  EXPECT_THAT(names, testing::ElementsAre("11/velodyne/000000.bin", "11/velodyne/000001.bin",
                                          "100/velodyne/000000.bin"));
}

// Sequences of test sets have none at all.
TEST(KittiRecording, TellsOfFramesThatLackTheLabelsOfOthers) {
  const TemporaryDirectory directory;
  const fs::path sequences = directory.path() / "sequences";
  for (const char* name : {"000000", "000001", "000002"}) WriteCloud(sequences / "00", name, 2, 30);
  WriteCloud(sequences / "11", "000000", 2, 30);
  fs::remove(sequences / "11/labels/000000.label");
  EXPECT_TRUE(OpenRecording(directory.path())->info().remarks->List().empty());
  fs::remove(sequences / "00/labels/000001.label");
  fs::remove(sequences / "00/labels/000002.label");
  EXPECT_EQ(OpenRecording(directory.path())->info().remarks->List(),
            (std::vector<Remark>{
                {RemarkKind::kLabelsMissing, (sequences / "00/velodyne/000001.bin").string(), 2}}));
}

TEST(KittiRecording, HasTheNamesOfTheConfigurationAboveItsClouds) {
  const TemporaryDirectory directory;
  const fs::path sequence = directory.path() / "sequences/00";
  WriteCloud(sequence, "000000", 2, 30);
  WriteFileWhole(directory.path() / "semantic-kitti.yaml", "labels: {30: \"somebody\"}\n");
  for (const fs::path& source :
       {directory.path(), sequence, sequence / "velodyne", sequence / "velodyne/000000.bin"}) {
    const RecordingInfo info = OpenRecording(source)->info();
    EXPECT_TRUE(info.has_kitti_labels);
    ASSERT_NE(info.labels.Find(30U), nullptr) << source;
    EXPECT_EQ(info.labels.Find(30U)->name, "somebody");
  }
  WriteFileWhole(directory.path() / "semantic-kitti.yaml", "labels: {30: \"\"}\n");
  EXPECT_EQ(MessageOf([&] { (void)OpenRecording(sequence); }),
            directory.path().string() + "/semantic-kitti.yaml: /labels/30: must be a name");
}

TEST(KittiRecording, OfOurOwnRunHasItsNames) {
  const TemporaryDirectory directory;
  (void)MakeSequence(directory.path() / "run", {.format = "kitti"});
  const LabelTable labels = OpenRecording(directory.path() / "run")->info().labels;
  ASSERT_NE(labels.Find(260U), nullptr);
  EXPECT_EQ(labels.Find(260U)->name, "rail");
  ASSERT_NE(labels.Find(256U), nullptr);
  EXPECT_EQ(labels.Find(256U)->name, "moving wagon");
}

TEST(KittiRecording, OfOurOwnRunHasPosesAndObjectsWithTheNamesOfItsLabels) {
  const TemporaryDirectory directory;
  for (const double speed_mps : {0.0, 5.0}) {
    const fs::path run = directory.path() / std::to_string(static_cast<int>(speed_mps));
    const MadeSequence made = MakeSequence(
        run, {.format = "kitti", .wagon_velocity_mps = Vector3(speed_mps, 0, 0), .start_frame = 3});
    const auto recording = OpenRecording(run);
    const std::vector<RecordedFrame> frames = ReadAll(*recording);
    ASSERT_EQ(frames.size(), 2U);
    for (std::size_t i = 0; i < frames.size(); ++i) {
      const RecordedFrame& recorded = frames[i];
      EXPECT_EQ(recorded.frame.index, i);
      EXPECT_EQ(recorded.frame.stamp_ns, made.frames[i].stamp_ns);
      EXPECT_EQ(recorded.axes, PointAxes::kSensorAtStamp);
      ASSERT_TRUE(recorded.has_pose);
      EXPECT_TRUE(
          recorded.frame.world_from_sensor.isApprox(made.frames[i].world_from_sensor, 1e-12));
      ASSERT_EQ(recorded.objects.size(), 1U);
      EXPECT_EQ(recorded.objects[0].label, speed_mps > 0.0 ? "moving wagon" : "wagon");
      EXPECT_NE(recording->info().labels.Find(recorded.objects[0].label), nullptr);
      EXPECT_EQ(recorded.objects[0].points_time_ns, 1003U + i);
    }
  }
}

}  // namespace
}  // namespace railcast
