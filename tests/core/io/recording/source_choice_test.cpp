#include "core/io/recording/source_choice.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include "core/io/recording/recording_extras.h"
#include "core/io/write_file.h"
#include "tests/core/io/message_of.h"
#include "tests/core/io/recording/read_all.h"
#include "tests/core/io/temporary_directory.h"

namespace railcast {
namespace {

TEST(WithChoice, NamesTheTopicOfBagsAlone) {
  const TemporaryDirectory folder;
  const std::filesystem::path bag = folder.path() / "run.mcap";
  std::ofstream(bag) << "";
  const std::vector<std::filesystem::path> sources = {"sequence", bag};
  EXPECT_EQ(WithChoice(sources, {}), sources);
  EXPECT_EQ(WithChoice(sources, {.topic = "/lidar/points"}),
            (std::vector<std::filesystem::path>{"sequence", bag.string() + ":/lidar/points"}));
  EXPECT_EQ(WithChoice({bag}, {.topic = "points"}),
            (std::vector<std::filesystem::path>{bag.string() + ":/points"}));
  EXPECT_EQ(MessageOf([&] { (void)WithChoice({"sequence"}, {.topic = "/lidar/points"}); }),
            "--topic: must come with a bag of ROS 2, .mcap, .db3 or a directory of them (got "
            "sequence)");
}

TEST(WithChoice, NamesTheFrameIdOfBagsBehindTheirTopics) {
  const TemporaryDirectory folder;
  const std::filesystem::path bag = folder.path() / "run.mcap";
  std::ofstream(bag) << "";
  using Paths = std::vector<std::filesystem::path>;
  EXPECT_EQ(WithChoice({"sequence", bag}, {.frame_id = "front"}),
            (Paths{"sequence", bag.string() + ":/#front"}));
  EXPECT_EQ(WithChoice({bag}, {.topic = "/points", .frame_id = "roof/left"}),
            (Paths{bag.string() + ":/points#roof/left"}));
  EXPECT_EQ(WithChoice({bag.string() + ":/points"}, {.frame_id = "front"}),
            (Paths{bag.string() + ":/points#front"}));
  EXPECT_EQ(MessageOf([&] { (void)WithChoice({"sequence"}, {.frame_id = "front"}); }),
            "--frame-id: must come with a bag of ROS 2, .mcap, .db3 or a directory of them (got "
            "sequence)");
}

/// Five float32 a point, as nuScenes has them.
void WriteNuScenes(const std::filesystem::path& file) {
  std::string bytes;
  for (int i = 0; i < 100; ++i) {
    const auto ring = static_cast<float>(i % 20);
    const std::array<float, 5> point = {9.5F, 0.25F * ring - 2.0F, 0.5F * ring - 1.0F, 0.25F, ring};
    bytes.append(reinterpret_cast<const char*>(point.data()), sizeof point);
  }
  WriteFileWhole(file, bytes);
}

TEST(WithChoice, NamesTheColumnsOfKittisFilesAndFolders) {
  const TemporaryDirectory folder;
  const std::filesystem::path drive = folder.path() / "drive";
  std::filesystem::create_directory(drive);
  WriteNuScenes(drive / "0.pcd.bin");
  EXPECT_THAT(MessageOf([&] { (void)ReadAll(drive); }),
              testing::EndsWith("fit: --kitti-columns nuscenes"));
  for (const std::filesystem::path& source : {drive, drive / "0.pcd.bin"}) {
    const auto chosen = WithChoice({source}, {.kitti_columns = "nuscenes"});
    EXPECT_EQ(chosen.front(), source.string() + ":nuscenes");
    const auto frames = ReadAll(chosen.front());
    ASSERT_EQ(frames.size(), 1U);
    EXPECT_TRUE(frames[0].Has("ring"));
    EXPECT_FLOAT_EQ(std::ranges::max(frames[0].frame.range_m), std::hypot(9.5F, 2.75F, 8.5F));
  }
  EXPECT_EQ(MessageOf([&] { (void)WithChoice({drive}, {.kitti_columns = "two"}); }),
            "--kitti-columns: must be 3 to 16, nuscenes, waymo or float64 (got two)");
  EXPECT_EQ(MessageOf([&] { (void)WithChoice({"a.pcd"}, {.kitti_columns = "5"}); }),
            "--kitti-columns: must come with .bin files or a directory of them (got a.pcd)");
}

TEST(WithChoice, NamesTheColumnsOfCloudsInText) {
  const TemporaryDirectory folder;
  const std::filesystem::path drive = folder.path() / "drive";
  std::filesystem::create_directory(drive);
  WriteFileWhole(drive / "0.xyz", "0.5 1 2 3\n");
  for (const std::filesystem::path& source : {drive, drive / "0.xyz"}) {
    const auto chosen = WithChoice({source}, {.columns = "intensity,x,y,z"});
    EXPECT_EQ(chosen.front(), source.string() + ":intensity,x,y,z");
    const auto frames = ReadAll(chosen.front());
    ASSERT_EQ(frames.size(), 1U);
    EXPECT_EQ(frames[0].frame.intensity[0], 0.5F);
  }
  EXPECT_EQ(MessageOf([&] { (void)WithChoice({drive}, {.columns = "x,y"}); }),
            "--columns: must be the names of columns, x, y and z among them, each once, and _ for "
            "those that are not used, as in x,y,z,_,intensity (got x,y)");
  EXPECT_EQ(MessageOf([&] { (void)WithChoice({"a.pcd"}, {.columns = "x,y,z"}); }),
            "--columns: must come with clouds in text, .xyz, .pts, .asc, .pc, .txt or .csv, or a "
            "directory of them (got a.pcd)");
}

TEST(RecordingExtras, SayWhatThisBuildLacks) {
  EXPECT_EQ(MessageOf([] { (void)NeedExtra(RecordingExtras().verify_trace, "a.osi", "osi"); }),
            "a.osi: needs the extra osi, which is not installed (Debian package railcast-osi; to "
            "build it, "
            "-D RAILCAST_BUILD_OSI=ON)");
}

}  // namespace
}  // namespace railcast
