// `--format objects` writes what is known of each frame without its cloud.
#include <gtest/gtest.h>

#include <filesystem>
#include <string>

#include "core/io/write_file.h"
#include "railcast/io/recording.h"
#include "tests/core/io/temporary_directory.h"
#include "tests/generator/project_folder.h"
#include "tests/generator/run_command.h"

namespace railcast {
namespace {

namespace fs = std::filesystem;

class ObjectsOnly : public testing::Test {
 protected:
  [[nodiscard]] fs::path Make(const std::string& format) const {
    const fs::path out = folder_.path() / format;
    const Ended run = Generate("sequence " + scenario_.string() + " --frames 3 --format " + format +
                               " --out " + out.string());
    EXPECT_EQ(run.status, 0) << run.said;
    return out;
  }

  const TemporaryDirectory folder_;
  const fs::path scenario_ = MakeProject(folder_.path() / "project");
};

TEST_F(ObjectsOnly, HasTheSameRecordsAsWithClouds) {
  const fs::path clouds = Make("pcd");
  const fs::path objects = Make("objects");
  for (const char* name : {"objects.jsonl", "poses.csv", "scenario.resolved.json"}) {
    EXPECT_EQ(ReadFileWhole(objects / name), ReadFileWhole(clouds / name)) << name;
  }
  EXPECT_FALSE(fs::exists(objects / "frames"));
}

TEST_F(ObjectsOnly, IsReadAsFramesWithoutPoints) {
  const auto with_clouds = OpenRecording(Make("pcd"));
  const auto without = OpenRecording(Make("objects"));
  int num_frames = 0;
  for (auto read = without->Next(); read; read = without->Next(), ++num_frames) {
    const RecordedFrame frame = (*read)();
    const RecordedFrame expected = (*with_clouds->Next())();
    EXPECT_EQ(frame.frame.num_slots(), 0U);
    EXPECT_EQ(frame.frame.index, expected.frame.index);
    EXPECT_TRUE(frame.frame.world_from_sensor.isApprox(expected.frame.world_from_sensor, 1e-15));
    ASSERT_EQ(frame.objects.size(), expected.objects.size());
    ASSERT_FALSE(frame.objects.empty());
    EXPECT_EQ(frame.objects.front().points, expected.objects.front().points);
  }
  EXPECT_EQ(num_frames, 3);
}

}  // namespace
}  // namespace railcast
