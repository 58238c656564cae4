#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdint>
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
  for (const auto& file : CloudFilesIn(folder.path()).files) frames.push_back(file.filename());
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

TEST(CloudNames, AreComparedAsTheTimesThatTheyHold) {
  const std::string day = "2026-11-30T";
  EXPECT_THAT(FramesOf({day + "10-00-00.pcd", day + "09-59-59.9.pcd", day + "10-00-00.100000.pcd",
                        day + "09-59-59.pcd"}),
              ElementsAre(day + "09-59-59.pcd", day + "09-59-59.9.pcd", day + "10-00-00.pcd",
                          day + "10-00-00.100000.pcd"));
  EXPECT_THAT(FramesOf({"c_20261130_100000_500000.ply", "c_20261130_100000.ply",
                        "c_20261130_095959_900000.ply"}),
              ElementsAre("c_20261130_095959_900000.ply", "c_20261130_100000.ply",
                          "c_20261130_100000_500000.ply"));
  // A number behind a date is none of its time if it goes beyond 59 s.
  EXPECT_THAT(FramesOf({"20261130_000060.pcd", "20261130_000059.pcd", "20261130_000100.pcd"}),
              ElementsAre("20261130_000059.pcd", "20261130_000060.pcd", "20261130_000100.pcd"));
}

TEST(CloudNames, MayHaveSigns) {
  EXPECT_THAT(FramesOf({"0.0.pcd", "-0.2.pcd", "0.1.pcd", "-0.1.pcd", "-10.0.pcd"}),
              ElementsAre("-10.0.pcd", "-0.2.pcd", "-0.1.pcd", "0.0.pcd", "0.1.pcd"));
  EXPECT_THAT(FramesOf({"t_-1.pcd", "t_2.pcd", "t_-3.pcd"}),
              ElementsAre("t_-3.pcd", "t_-1.pcd", "t_2.pcd"));
  EXPECT_THAT(FramesOf({"frame-1.pcd", "frame-10.pcd", "frame-2.pcd"}),
              ElementsAre("frame-1.pcd", "frame-2.pcd", "frame-10.pcd"));
}

/// The names of the files that are left out of a folder.
std::vector<std::string> LeftOutOf(const std::vector<std::string>& names) {
  std::vector<std::filesystem::path> files(names.begin(), names.end());
  std::vector<std::string> others;
  for (const auto& file : SeriesOfClouds(files, "").others) others.push_back(file);
  return others;
}

TEST(CloudNames, OfCopiesAndStrangersAreLeftOut) {
  EXPECT_THAT(LeftOutOf({"000000.pcd", "000001.pcd", "000001 (1).pcd", "000001 - Copy.pcd",
                         "000001 - \u526f\u672c.pcd", "000001_copy2.pcd", "Kopie von 000000.pcd"}),
              testing::UnorderedElementsAre("000001 (1).pcd", "000001 - Copy.pcd",
                                            "000001 - \u526f\u672c.pcd", "000001_copy2.pcd",
                                            "Kopie von 000000.pcd"));
  EXPECT_THAT(LeftOutOf({"a_1.ply", "a_2.ply", "a_3.ply", "map.ply"}), ElementsAre("map.ply"));
  EXPECT_THAT(LeftOutOf({"a b 1.ply", "a b 2.ply", "Copy of a b 1.ply", "Copie de a b 2.ply",
                         "Kopie (2) von a b 2.ply"}),
              testing::UnorderedElementsAre("Copy of a b 1.ply", "Copie de a b 2.ply",
                                            "Kopie (2) von a b 2.ply"));
  // Names may begin as the word does.
  for (const std::string begin : {"Kopenhagen_", "copter", "Copy ", "cop-", "kopter 2 "}) {
    EXPECT_THAT(LeftOutOf({begin + "0001.pcd", begin + "0002.pcd", begin + "0003.pcd"}),
                ElementsAre())
        << begin;
  }
  // A file manager numbers them so.
  EXPECT_THAT(LeftOutOf({"scan (1).ply", "scan (2).ply", "scan (10).ply"}), ElementsAre());
  EXPECT_THAT(LeftOutOf({"street.ply", "yard.ply", "bridge 2.ply"}), ElementsAre());
}

TEST(CloudNames, OfSeveralSensorsAreRefused) {
  const auto fault = [](const std::vector<std::string>& names) {
    return MessageOf([&] { (void)LeftOutOf(names); });
  };
  EXPECT_THAT(fault({"d/front_1.pcd", "d/front_2.pcd", "d/rear_1.pcd", "d/rear_2.pcd"}),
              "d: must hold one series of clouds (got front_# of 2 files, rear_# of 2 files); "
              "d/front_# opens the first");
  EXPECT_THAT(fault({"d/lidar1_0.1.bin", "d/lidar2_0.1.bin", "d/lidar1_0.2.bin", "d/lidar2_0.2.bin",
                     "d/lidar1_0.3.bin"}),
              testing::HasSubstr("(got lidar1_# of 3 files, lidar2_# of 2 files)"));
  EXPECT_THAT(fault({"d/01_000.bin", "d/01_001.bin", "d/02_000.bin", "d/02_001.bin"}),
              testing::HasSubstr("(got 01_# of 2 files, 02_# of 2 files)"));
  // Seconds and tenths, and one drive after the other.
  EXPECT_EQ(fault({"d/17_8.pcd", "d/17_9.pcd", "d/18_0.pcd", "d/18_1.pcd"}), "no error");
  EXPECT_EQ(fault({"d/a_1.pcd", "d/a_2.pcd", "d/b_3.pcd", "d/b_4.pcd"}), "no error");
}

/// Names of so many seconds and fractions of them, such as "17_0.pcd", in the order of time.
std::vector<std::filesystem::path> TimedNames(const std::string& begin,
                                              std::size_t num_seconds,
                                              std::size_t rate_hz,
                                              std::size_t num_digits) {
  std::uint64_t second = 1;
  for (std::size_t i = 0; i < num_digits; ++i) second *= 10;
  std::vector<std::filesystem::path> names;
  for (std::size_t i = 0; i < num_seconds * rate_hz; ++i) {
    const std::string digits = std::to_string(second + i % rate_hz * (second / rate_hz));
    names.emplace_back(begin + std::to_string(10 + i / rate_hz) + "_" + digits.substr(1) + ".pcd");
  }
  return names;
}

// Fewer seconds than fractions, as many, or more; and times whose seconds are their last numbers.
TEST(CloudNames, OfSecondsAndFractionsAreOneSeries) {
  for (const std::size_t rate_hz : {2U, 5U, 10U, 20U}) {
    for (const std::size_t num_digits : {1U, 3U, 6U, 9U}) {
      if (num_digits == 1 && rate_hz > 10) continue;
      for (const std::size_t num_seconds : {rate_hz - 1, rate_hz, rate_hz + 1, 3 * rate_hz}) {
        for (const char* const begin : {"", "scan_", "scan_17000000", "20261130_1000"}) {
          const std::vector<std::filesystem::path> names =
              TimedNames(begin, std::min<std::size_t>(num_seconds, 49), rate_hz, num_digits);
          EXPECT_EQ(SeriesOfClouds({names.rbegin(), names.rend()}, "").files, names)
              << begin << num_seconds << " s at " << rate_hz;
        }
      }
    }
  }
}

TEST(CloudNames, OfNumberedSourcesAreNoFractions) {
  const auto fault = [](const std::vector<std::string>& names) {
    return MessageOf([&] { (void)LeftOutOf(names); });
  };
  for (const std::size_t num_frames : {2U, 3U, 10U, 500U, 1000U}) {
    for (const std::size_t num_digits : {3U, 4U, 6U, 9U}) {
      std::vector<std::string> names;
      for (std::size_t i = 0; i < 2 * num_frames; ++i) {
        const std::string index = std::to_string(i / 2);
        names.push_back("d/0" + std::to_string(1 + i % 2) + "_" +
                        std::string(num_digits - index.size(), '0') + index + ".bin");
      }
      const std::string of = "# of " + std::to_string(num_frames) + " files";
      EXPECT_THAT(fault(names), testing::HasSubstr("(got 01_" + of + ", 02_" + of + ")"));
    }
  }
  // Of sensors 1 and 2 of any name ten frames each.
  std::vector<std::string> names;
  for (int i = 0; i < 20; ++i) {
    names.push_back("d/lidar" + std::to_string(1 + i / 10) + "_" + std::to_string(i % 10) + ".bin");
  }
  EXPECT_THAT(fault(names), testing::HasSubstr("(got lidar1_# of 10 files, lidar2_# of 10 files)"));
}

TEST(CloudNames, OfOneSeriesMayBeChosen) {
  const TemporaryDirectory folder;
  for (const char* const name : {"front_1.ply", "front_2.ply", "rear_1.ply", "rear_2.ply"}) {
    WriteFileWhole(folder.path() / name, "");
  }
  EXPECT_THAT(CloudFilesIn(folder.path() / "rear_#").files,
              ElementsAre(folder.path() / "rear_1.ply", folder.path() / "rear_2.ply"));
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

TEST(CloudNames, AreStampsWhereAllHoldATimeOfThisCentury) {
  using Paths = std::vector<std::filesystem::path>;
  EXPECT_THAT(StampsOfNames(Paths{"n015__LIDAR_TOP__1532402927647951.pcd.bin",
                                  "n015__LIDAR_TOP__1532402928147847.pcd.bin"}),
              ElementsAre(1'532'402'927'647'951'000, 1'532'402'928'147'847'000));
  EXPECT_THAT(StampsOfNames(Paths{"1532402927647.bin", "1532402927747.bin"}),
              ElementsAre(1'532'402'927'647'000'000, 1'532'402'927'747'000'000));
  EXPECT_THAT(StampsOfNames(Paths{"1532402927647951123.bin", "1532402927747951123.bin"}),
              ElementsAre(1'532'402'927'647'951'123, 1'532'402'927'747'951'123));
  EXPECT_THAT(StampsOfNames(Paths{"1556089560_000000000.pcd", "1556089560_100000000.pcd"}),
              ElementsAre(1'556'089'560'000'000'000, 1'556'089'560'100'000'000));
  EXPECT_THAT(
      StampsOfNames(Paths{"2026-11-30 10:00:00+01:00.pcd", "2026-11-30 10:00:00.1+01:00.pcd"}),
      ElementsAre(1'796'029'200'000'000'000, 1'796'029'200'100'000'000));
  EXPECT_THAT(StampsOfNames(Paths{"-0.1.pcd", "0.0.pcd"}), ElementsAre(-100'000'000, 0));
  // A time of the log, and numbers of frames.
  EXPECT_THAT(StampsOfNames(Paths{"2026-11-30-10-00-00_1.pcd", "2026-11-30-10-00-00_2.pcd"}),
              ElementsAre());
  EXPECT_THAT(
      StampsOfNames(Paths{"2026-11-30-10-00-00_000001.pcd", "2026-11-30-10-00-00_000002.pcd"}),
      ElementsAre());
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
  std::filesystem::copy(folder.path() / "1.5.ply", folder.path() / "1.5 (1).ply");
  const auto recording = OpenRecording(folder.path());
  EXPECT_EQ(recording->info().num_frames, 2U);
  EXPECT_EQ(recording->info().remarks->List(),
            (std::vector<Remark>{{RemarkKind::kFilesLeftOut, folder.path().string(), 1,
                                  "1.5 (1).ply is none of the series"}}));
}

}  // namespace
}  // namespace railcast
