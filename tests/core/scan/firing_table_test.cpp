#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>

#include "tests/core/scan/pattern_angles.h"

namespace railcast {
namespace {

/// Writes a table for one test and removes it afterwards.
class FiringTable : public testing::Test {
 protected:
  ~FiringTable() override { std::filesystem::remove(file_); }

  ScanSpec Write(const std::string& text, std::uint32_t frames = 1) const {
    std::ofstream(file_, std::ios::binary) << text;
    return {.rate_hz = 10.0, .pattern = FiringTableSpec{file_, frames}};
  }

  /// The faults, with the file name shortened to "table.csv".
  std::string FaultsOfText(const std::string& text, std::uint32_t frames = 1) const {
    std::string faults = FaultsOf(Write(text, frames));
    for (std::size_t at = 0; (at = faults.find(file_, at)) != std::string::npos;) {
      faults.replace(at, file_.size(), "table.csv");
    }
    return faults;
  }

 private:
  const std::string file_ =
      testing::TempDir() + testing::UnitTest::GetInstance()->current_test_info()->name() + ".csv";
};

constexpr char kHeader[] = "azimuth_deg,elevation_deg,time_us\n";
constexpr char kRingHeader[] = "azimuth_deg,elevation_deg,time_us,ring\n";

TEST_F(FiringTable, GivesOneRowInTheOrderOfTheFile) {
  const ScanPattern pattern = BuildScanPattern(
      Write("azimuth_deg,elevation_deg,time_us\r\n10,-5,0\r\n -20.5 , 7.25 ,12.5\r\n0,0,12.5"));
  ASSERT_EQ(pattern.num_firings(), 3U);
  EXPECT_EQ(pattern.rows, 1U);
  EXPECT_EQ(pattern.columns, 3U);
  EXPECT_EQ(pattern.column, (std::vector<std::uint32_t>{0, 1, 2}));
  EXPECT_EQ(pattern.time_ns, (std::vector<std::uint32_t>{0, 12500, 12500}));
  EXPECT_NEAR(AzimuthInDegrees(pattern, 1), -20.5, kFloatAngle_deg);
  EXPECT_NEAR(ElevationInDegrees(pattern, 1), 7.25, kFloatAngle_deg);
}

TEST_F(FiringTable, MayBeginWithAByteOrderMark) {
  EXPECT_EQ(
      BuildScanPattern(Write(std::string("\xEF\xBB\xBF") + kHeader + "10,+5,0.0")).num_firings(),
      1U);
  std::string utf16 = "\xFF\xFE";
  for (const char letter : std::string(kHeader) + "10,5,0") utf16 += {letter, '\0'};
  EXPECT_EQ(BuildScanPattern(Write(utf16)).num_firings(), 1U);
}

TEST_F(FiringTable, HasARowForEachRingAndAColumnForEachOfItsFirings) {
  const ScanPattern pattern = BuildScanPattern(Write(
      std::string(kRingHeader) + "0,2,0,1\n0,-3,1,0\n-1,-3,2,0\n-1,2,3,1\n-2,-3,4,0\n-2,2,5,1"));
  EXPECT_EQ(pattern.rows, 2U);
  EXPECT_EQ(pattern.columns, 3U);
  EXPECT_EQ(pattern.row, (std::vector<std::uint16_t>{1, 0, 0, 1, 0, 1}));
  EXPECT_EQ(pattern.column, (std::vector<std::uint32_t>{0, 0, 1, 1, 2, 2}));
  EXPECT_NEAR(ElevationInDegrees(pattern, 0), 2.0, kFloatAngle_deg);
}

TEST_F(FiringTable, RefusesRingsThatAreNoRowsOfAGrid) {
  EXPECT_EQ(FaultsOfText(std::string(kRingHeader) + "0,0,0,0\n0,1,0,1\n1,1,1,1\n"),
            "table.csv: ring: ring 1 must have as many firings as ring 0, 1; one that fires "
            "oftener is several (got 2)");
  EXPECT_EQ(FaultsOfText(std::string(kRingHeader) + "0,0,0,2\n"),
            "table.csv: ring: ring 2 must have as many firings as ring 0, 0; one that fires "
            "oftener is several (got 1)");
  EXPECT_EQ(FaultsOfText(std::string(kRingHeader) + "0,5,0,0\n0,3,0,1\n"),
            "table.csv: ring: ring 1 must lie no lower, on average, than the ring before it "
            "(got -2 deg)");
  EXPECT_EQ(FaultsOfText(std::string(kRingHeader) + "0,0,0,-1\n0,0,0,0.5\n0,0,0,65536\n0,0,0\n"),
            "table.csv:2: ring: must be a whole number from 0 to 65535 (got -1)\n"
            "table.csv:3: ring: must be a whole number from 0 to 65535 (got 0.5)\n"
            "table.csv:4: ring: must be a whole number from 0 to 65535 (got 65536)\n"
            "table.csv:5: must have 4 values (got 3)");
}

TEST_F(FiringTable, OfSeveralFramesIsGoneThroughFrameByFrameAndBeginsAgain) {
  const ScanPattern pattern =
      BuildScanPattern(Write(std::string(kHeader) + "1,0,0\n2,0,50000\n3,5,100000\n4,5,150000.4\n"
                                                    "5,0,200000\n6,0,249999.6\n",
                             3));
  EXPECT_FALSE(pattern.repeats());
  EXPECT_EQ(pattern.rows, 1U);
  EXPECT_EQ(pattern.columns, 2U);
  for (std::uint32_t frame = 0; frame < 7; ++frame) {
    const ScanPattern of_frame = PatternOfFrame(pattern, frame);
    EXPECT_EQ(of_frame.time_ns, (std::vector<std::uint32_t>{0, 50'000'000}));
    EXPECT_NEAR(AzimuthInDegrees(of_frame, 0), 1.0 + 2.0 * (frame % 3), kFloatAngle_deg);
    EXPECT_NEAR(AzimuthInDegrees(of_frame, 1), 2.0 + 2.0 * (frame % 3), kFloatAngle_deg);
    EXPECT_NEAR(ElevationInDegrees(of_frame, 1), frame % 3 == 1 ? 5.0 : 0.0, kFloatAngle_deg);
  }
}

TEST_F(FiringTable, OfSeveralFramesHasTheSameRingsInAll) {
  const ScanPattern pattern = BuildScanPattern(
      Write(std::string(kRingHeader) + "0,2,0,1\n0,-3,0,0\n1,4,100000,1\n1,-1,100000,0\n", 2));
  EXPECT_EQ(pattern.rows, 2U);
  EXPECT_EQ(pattern.columns, 1U);
  const ScanPattern second = PatternOfFrame(pattern, 1);
  EXPECT_EQ(second.row, pattern.row);
  EXPECT_NEAR(ElevationInDegrees(second, 0), -1.0, kFloatAngle_deg);
  EXPECT_NEAR(ElevationInDegrees(second, 1), 4.0, kFloatAngle_deg);
}

TEST_F(FiringTable, RefusesFramesThatDifferInMoreThanDirections) {
  EXPECT_EQ(FaultsOfText(std::string(kHeader) + "0,0,0\n0,0,5\n0,0,100000\n", 2),
            "table.csv: must have as many firings in each of its 2 frames (got 3)");
  EXPECT_EQ(FaultsOfText(std::string(kHeader) + "0,0,0\n0,0,5\n0,0,100000\n0,0,100007\n", 2),
            "table.csv:5: time_us: must be that of the same firing in the first frame, and the "
            "periods since, to 1 us: 100005 (got 100007)");
  EXPECT_EQ(FaultsOfText(std::string(kRingHeader) + "0,0,0,0\n0,0,0,1\n0,0,1e5,1\n0,0,1e5,0\n", 2),
            "table.csv:4: ring: must be that of the same firing in the first frame, 0 (got 1)");
  EXPECT_EQ(FaultsOfText(std::string(kHeader) + "0,0,0\n0,0,9e6\n", 2),
            "table.csv:3: time_us: must be <= 8589934 (got 9e+06)");
  EXPECT_EQ(FaultsOfText(std::string(kHeader) + "0,0,0\n", 0),
            "/pattern/frames: must be >= 1 and <= 100000 (got 0)");
}

TEST_F(FiringTable, NamesLineAndColumnOfWhatIsNoNumber) {
  EXPECT_EQ(FaultsOfText(std::string(kHeader) + "0,0,0\nabc,1,2x\n1,nan,3\n,0,4\n"),
            "table.csv:3: azimuth_deg: not a number (got \"abc\")\n"
            "table.csv:3: time_us: not a number (got \"2x\")\n"
            "table.csv:4: elevation_deg: must be finite (got \"nan\")\n"
            "table.csv:5: azimuth_deg: not a number (got \"\")");
}

TEST_F(FiringTable, RefusesLinesOfAnotherLength) {
  EXPECT_EQ(FaultsOfText(std::string(kHeader) + "0,0,0\n1,2\n1,2,3,4\n\n"),
            "table.csv:3: must have 3 values (got 2)\n"
            "table.csv:4: must have 3 values (got 4)\n"
            "table.csv:5: must have 3 values (got 1)");
}

TEST_F(FiringTable, RefusesTimesThatDecreaseOrDoNotStartAtZero) {
  EXPECT_EQ(FaultsOfText(std::string(kHeader) + "0,0,1\n0,0,5\n0,0,4.5\n"),
            "table.csv:2: time_us: the first must be 0 (got 1)\n"
            "table.csv:4: time_us: must not decrease (got 4.5)");
}

TEST_F(FiringTable, RefusesAnglesThatCannotBe) {
  EXPECT_EQ(FaultsOfText(std::string(kHeader) + "361,-91,0\n"),
            "table.csv:2: azimuth_deg: must be >= -360 and <= 360 (got 361)\n"
            "table.csv:2: elevation_deg: must be >= -90 and <= 90 (got -91)");
}

TEST_F(FiringTable, RefusesFramesLongerThanThePeriodAnd32BitsOfNanoseconds) {
  EXPECT_EQ(FaultsOfText(std::string(kHeader) + "0,0,0\n0,0,100000\n"),
            "/pattern: the last firing must come before 1 / rate_hz (got 0.1)");
  EXPECT_EQ(FaultsOfText(std::string(kHeader) + "0,0,0\n0,0,1e30\n"),
            "table.csv:3: time_us: must be <= 4294967 (got 1e+30)");
}

TEST_F(FiringTable, RefusesFilesWithoutHeaderOrFirings) {
  EXPECT_EQ(FaultsOfText(""),
            "table.csv:1: must be \"azimuth_deg,elevation_deg,time_us\" or "
            "\"azimuth_deg,elevation_deg,time_us,ring\" (got \"\")");
  EXPECT_EQ(FaultsOfText("azimuth,elevation,time\n0,0,0\n"),
            "table.csv:1: must be \"azimuth_deg,elevation_deg,time_us\" or "
            "\"azimuth_deg,elevation_deg,time_us,ring\" (got \"azimuth,elevation,time\")");
  EXPECT_EQ(FaultsOfText(kHeader), "table.csv: must have at least one firing (got 0)");
}

TEST_F(FiringTable, RefusesAMissingFile) {
  EXPECT_EQ(FaultsOf({.rate_hz = 10.0, .pattern = FiringTableSpec{"no/such.csv"}}),
            "/pattern/file: no/such.csv: no such file or directory");
}

TEST_F(FiringTable, StopsAfterTwentyFaults) {
  std::string text = kHeader;
  for (int i = 0; i < 100; ++i) text += "x,0,0\n";
  const std::string faults = FaultsOf(Write(text));
  EXPECT_EQ(std::ranges::count(faults, '\n'), 19);
}

}  // namespace
}  // namespace railcast
