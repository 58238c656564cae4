#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <string>
#include <vector>

#include "core/io/recording/recording_kinds.h"
#include "core/io/write_file.h"
#include "railcast/io/recording.h"
#include "tests/core/io/message_of.h"
#include "tests/core/io/recording/read_all.h"
#include "tests/core/io/temporary_directory.h"

namespace railcast {
namespace {

using testing::ElementsAre;

/// The names of the frames of a folder that holds files of these names.
std::vector<std::string> FramesOf(const std::vector<std::string>& names) {
  const TemporaryDirectory folder;
  for (const std::string& name : names) WriteFileWhole(folder.path() / name, "");
  std::vector<std::string> frames;
  for (const auto& file : CloudFilesIn(folder.path())) frames.push_back(file.filename());
  return frames;
}

TEST(CloudNames, AreComparedAsDecimalNumbersWhereAllAreSuch) {
  EXPECT_THAT(FramesOf({"17.1.pcd", "17.2.pcd", "17.05.pcd", "17.15.pcd", "9.9.pcd"}),
              ElementsAre("9.9.pcd", "17.05.pcd", "17.1.pcd", "17.15.pcd", "17.2.pcd"));
  EXPECT_THAT(FramesOf({"c_1.5_x.pcd", "c_1.25_x.pcd"}),
              ElementsAre("c_1.25_x.pcd", "c_1.5_x.pcd"));
  // A whole second has no point.
  EXPECT_THAT(FramesOf({"17.5.pcd", "18.pcd", "17.25.pcd"}),
              ElementsAre("17.25.pcd", "17.5.pcd", "18.pcd"));
  // The tenth of the first.
  EXPECT_THAT(FramesOf({"1.1.pcd", "1.2.pcd", "1.10.pcd"}),
              ElementsAre("1.1.pcd", "1.2.pcd", "1.10.pcd"));
}

TEST(CloudNames, MayEndInAnyCaseButNotBeginWithAPoint) {
  EXPECT_THAT(FramesOf({"1.pcd", "2.PCD", "._1.pcd", ".pcd", "3.Ply", "4.BIN"}),
              ElementsAre("1.pcd", "2.PCD", "3.Ply", "4.BIN"));
}

TEST(CloudNames, OfOneFrameInTwoFormatsAreRefused) {
  EXPECT_THAT(MessageOf([] {
                (void)FramesOf({"1.pcd", "2.pcd", "1.ply"});
              }),
              testing::EndsWith(": must have each frame in one format (got 1.pcd and 1.ply)"));
}

TEST(CloudNames, AreStampsWhereAllAreSeconds) {
  using Paths = std::vector<std::filesystem::path>;
  EXPECT_THAT(StampsOfNames(Paths{"1700000000.05.pcd", "1700000000.150000001.pcd"}),
              ElementsAre(1'700'000'000'050'000'000, 1'700'000'000'150'000'001));
  EXPECT_THAT(StampsOfNames(Paths{"1.pcd", "2.pcd"}), ElementsAre());
  EXPECT_THAT(StampsOfNames(Paths{"a1.5.pcd", "a2.5.pcd"}), ElementsAre());
}

TEST(CloudNames, MayHaveNanosecondsWithoutZerosInFront) {
  EXPECT_THAT(FramesOf({"17.949999875.pcd", "17.49999872.pcd", "17.149999875.pcd", "18.0.pcd"}),
              ElementsAre("17.49999872.pcd", "17.149999875.pcd", "17.949999875.pcd", "18.0.pcd"));
  using Paths = std::vector<std::filesystem::path>;
  EXPECT_THAT(StampsOfNames(Paths{"17.49999872.pcd", "17.149999875.pcd"}),
              ElementsAre(17'049'999'872, 17'149'999'875));
  EXPECT_THAT(FramesOf({"17.5.pcd", "17.166666667.pcd", "17.333333333.pcd"}),
              ElementsAre("17.166666667.pcd", "17.333333333.pcd", "17.5.pcd"));
  EXPECT_THAT(StampsOfNames(Paths{"17.1000000000.pcd", "17.2.pcd"}),
              ElementsAre(17'100'000'000, 17'200'000'000));
  // Decimal fractions may begin with zeros.
  EXPECT_THAT(StampsOfNames(Paths{"17.04999987.pcd", "17.149999875.pcd"}),
              ElementsAre(17'049'999'870, 17'149'999'875));
}

TEST(CloudNames, GiveFramesTheirStamps) {
  const TemporaryDirectory folder;
  for (const char* const name : {"1.5.ply", "1.25.ply"}) {
    WriteFileWhole(folder.path() / name,
                   "ply\nformat ascii 1.0\nelement vertex 1\nproperty float x\nproperty float y\n"
                   "property float z\nend_header\n1 2 3\n");
  }
  const auto frames = ReadAll(folder.path());
  ASSERT_EQ(frames.size(), 2U);
  EXPECT_EQ(frames[0].frame.stamp_ns, 1'250'000'000);
  EXPECT_EQ(frames[1].frame.stamp_ns, 1'500'000'000);
}

}  // namespace
}  // namespace railcast
