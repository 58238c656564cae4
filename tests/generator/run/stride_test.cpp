#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "tests/core/io/message_of.h"
#include "tests/core/io/temporary_directory.h"
#include "tests/generator/example_run.h"

namespace railcast {
namespace {

using testing::ElementsAre;

/// Frames 3, 8, 13, 18 of the example.
SequenceSpec SparseRun(const std::filesystem::path& directory, const std::string& format = "pcd") {
  SequenceSpec spec = ExampleRun(directory, format, 4);
  spec.stride = 5;
  return spec;
}

TEST(Stride, ChoosesTheFramesAndNamesTheirFilesByTheirNumbers) {
  const TemporaryDirectory directory;
  std::vector<std::uint32_t> made;
  const ExampleFrames make = [&](std::uint32_t index, Frame& frame, auto& objects) {
    made.push_back(index);
    MakeExampleFrame(index, frame, objects);
  };
  EXPECT_TRUE(RunSequence(SparseRun(directory.path()), make, NoHooks()).is_complete);
  EXPECT_THAT(made, ElementsAre(3, 8, 13, 18));
  const auto contents = Contents(directory.path());
  EXPECT_TRUE(contents.contains("frames/000018.pcd"));
  EXPECT_FALSE(contents.contains("frames/000004.pcd"));
}

TEST(Stride, NumbersTheFilesOfKittiOneAfterAnother) {
  const TemporaryDirectory directory;
  (void)RunSequence(SparseRun(directory.path(), "kitti"), MakeExampleFrame, NoHooks());
  const auto contents = Contents(directory.path());
  EXPECT_TRUE(contents.contains("sequences/00/velodyne/000003.bin"));
  EXPECT_FALSE(contents.contains("sequences/00/velodyne/000004.bin"));
}

TEST(Stride, AStoppedRunContinuesWithTheSameBytes) {
  for (const char* const format : {"pcd", "kitti"}) {
    const TemporaryDirectory directory;
    (void)RunSequence(SparseRun(directory.path() / "whole", format), MakeExampleFrame, NoHooks());
    const SequenceSpec stopped = SparseRun(directory.path() / "stopped", format);
    int num_frames = 0;
    const SequenceHooks hooks = {[](std::uint32_t, std::uint32_t) {},
                                 [&] { return ++num_frames > 2; }};
    EXPECT_FALSE(RunSequence(stopped, MakeExampleFrame, hooks).is_complete);
    const SequenceResult rest = RunSequence(stopped, MakeExampleFrame, NoHooks());
    EXPECT_EQ(rest.num_resumed, 2U);
    EXPECT_EQ(Contents(directory.path() / "stopped"), Contents(directory.path() / "whole"));
  }
}

TEST(Stride, BelongsToTheRun) {
  const TemporaryDirectory directory;
  const auto message = [&](std::uint32_t stride) {
    SequenceSpec spec = SparseRun(directory.path());
    spec.stride = stride;
    return MessageOf([&] { (void)RunSequence(spec, MakeExampleFrame, NoHooks()); });
  };
  EXPECT_EQ(message(5), "no error");
  const std::string place = directory.path().string() + ": ";
  EXPECT_EQ(message(4),
            place + "holds another run: its --stride is 5 (got 4); choose another --out");
  EXPECT_EQ(message(1),
            place + "holds another run: its --stride is 5 (got 1); choose another --out");
}

}  // namespace
}  // namespace railcast
