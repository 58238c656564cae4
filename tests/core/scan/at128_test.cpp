#include "core/scan/at128.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <string>
#include <vector>

#include "core/base/bytes.h"
#include "core/base/input_file.h"
#include "core/base/units.h"
#include "tests/core/io/message_of.h"
#include "tests/core/io/temporary_directory.h"
#include "tests/core/scan/pattern_angles.h"
#include "tests/support/sensor_file.h"

namespace railcast {
namespace {

/// The azimuths and elevations of the firings of each row, from left to right, in degrees.
using SweptRows = std::vector<std::vector<std::pair<double, double>>>;

SweptRows RowsOfSweep(const ScanPattern& pattern) {
  SweptRows rows(pattern.rows, {pattern.columns, {0.0, 0.0}});
  for (std::size_t i = 0; i < pattern.num_firings(); ++i) {
    rows[pattern.row[i]][pattern.column[i]] = {AzimuthInDegrees(pattern, i),
                                               ElevationInDegrees(pattern, i)};
  }
  return rows;
}

TEST(At128Sweep, HasAFrameOf120DegreesForEachMirrorInTurn) {
  const ScanPattern first = BuildScanPattern(ReadSensor("at128"));
  EXPECT_EQ(first.rows, 128U);
  EXPECT_EQ(first.columns, 1200U);
  EXPECT_FALSE(first.repeats());
  EXPECT_NEAR(*std::ranges::max_element(first.time_ns), 1199 * 41'666 + 14'928, 1);
  std::vector<SweptRows> sweeps;
  for (const std::uint32_t frame : {0U, 1U, 2U, 3U}) {
    const SweptRows& rows = sweeps.emplace_back(RowsOfSweep(PatternOfFrame(first, frame)));
    for (const auto& row : rows) {
      // The lasers look up to 2.4 deg beside the block's azimuth.
      EXPECT_NEAR(row.front().first, 60.0, 2.5);
      EXPECT_NEAR(row.back().first, -60.0, 2.5);
      for (std::size_t column = 1; column < row.size(); ++column) {
        ASSERT_NEAR(row[column - 1].first - row[column].first, 0.1, 1e-3);
      }
    }
    EXPECT_NEAR(rows.front()[600].second, -12.47, 1e-4);
    EXPECT_NEAR(rows.back()[600].second, 12.93, 1e-4);
  }
  EXPECT_EQ(sweeps[3], sweeps[0]);
}

TEST(At128Sweep, HasHalfTheBlocksAtTwiceTheRate) {
  ScanSpec scan = ReadSensor("at128");
  scan.rate_hz = 20.0;
  const ScanPattern pattern = BuildScanPattern(scan);
  EXPECT_EQ(pattern.columns, 600U);
  const auto row = RowsOfSweep(pattern)[64];
  EXPECT_NEAR(row[300].first - row[301].first, 0.2, 1e-3);
}

/// The scan of the preset with a real unit's file.
ScanSpec ScanOfUnit(const std::filesystem::path& file) {
  ScanSpec scan = ReadSensor("at128");
  std::get<FiringTableSpec>(scan.pattern).file = file.string();
  return scan;
}

// The preset has what units have in common: their mirrors stand up to 0.3 deg beside a third of a
// turn, and lasers are shifted up to 0.9 deg in azimuth and 0.5 deg in elevation.
TEST(At128Sweep, IsNearThoseOfTwoRealUnits) {
  const std::filesystem::path data = RAILCAST_SHARED_DATA_DIR;
  if (!exists(data)) GTEST_SKIP() << data << " is not there";
  const ScanPattern preset = BuildScanPattern(ReadSensor("at128"));
  for (const char* name : {"hesai_calibration/PandarAT128.dat",
                           "lidar_hesai/calibration/sdk_AT128E3X_Angle_Correction_File.dat"}) {
    const ScanPattern unit = BuildScanPattern(ScanOfUnit(data / name));
    std::vector<SweptRows> sweeps;
    double most_aside_deg = 0.0;
    double most_above_deg = 0.0;
    for (const std::uint32_t frame : {0U, 1U, 2U}) {
      const SweptRows expected = RowsOfSweep(PatternOfFrame(preset, frame));
      const SweptRows& rows = sweeps.emplace_back(RowsOfSweep(PatternOfFrame(unit, frame)));
      for (std::size_t row = 0; row < rows.size(); ++row) {
        for (std::size_t column = 0; column < rows[row].size(); ++column) {
          const auto [azimuth_deg, elevation_deg] = rows[row][column];
          const auto [nominal_azimuth_deg, nominal_elevation_deg] = expected[row][column];
          most_aside_deg = std::max(most_aside_deg, std::abs(azimuth_deg - nominal_azimuth_deg));
          most_above_deg =
              std::max(most_above_deg, std::abs(elevation_deg - nominal_elevation_deg));
        }
      }
    }
    EXPECT_LT(most_aside_deg, 1.13) << name;
    EXPECT_LT(most_above_deg, 0.48) << name;
    RecordProperty("aside", std::to_string(most_aside_deg));
    RecordProperty("above", std::to_string(most_above_deg));
    EXPECT_NE(sweeps[1], sweeps[0]);
    EXPECT_NE(sweeps[2], sweeps[1]);
  }
}

/// Whether a firing of the sweep has this direction: to a step between blocks, which may change
/// shifts, and to a hundredth of the step between lasers.
bool LooksThere(const SweptRows& rows, double azimuth_deg, double elevation_deg) {
  return std::ranges::any_of(rows, [&](const auto& row) {
    const auto place = static_cast<std::ptrdiff_t>((row.front().first - azimuth_deg) / 0.1);
    for (std::ptrdiff_t i = place - 10; i <= place + 10; ++i) {
      if (i < 0 || i >= static_cast<std::ptrdiff_t>(row.size())) continue;
      const auto& [azimuth, elevation] = row[static_cast<std::size_t>(i)];
      const bool is_near = std::abs(azimuth - azimuth_deg) < 0.105;
      if (is_near && std::abs(elevation - elevation_deg) < 0.002) return true;
    }
    return false;
  });
}

// The cloud is of the first mirror. Lasers are 0.2 deg apart: by chance, one in fifty points would
// be as near.
TEST(At128Sweep, LooksWhereTheRealSensorOfItsFileDoes) {
  const std::filesystem::path file =
      RAILCAST_SHARED_DATA_DIR "/hesai_calibration/at128_1679653308704927652.pcd";
  if (!exists(file)) GTEST_SKIP() << file << " is not there";
  std::ostringstream text;
  text << std::ifstream(file, std::ios::binary).rdbuf();
  const std::string bytes = text.str();
  constexpr std::string_view kData = "DATA binary\n";
  constexpr std::size_t kPoints = 10'198;
  const std::size_t begin = bytes.find(kData) + kData.size();
  ASSERT_EQ(bytes.size(), begin + 12 * kPoints);
  const SweptRows rows =
      RowsOfSweep(BuildScanPattern(ScanOfUnit(file.parent_path() / "PandarAT128.dat")));
  std::size_t num_seen = 0;
  for (std::size_t i = 0; i < kPoints; ++i) {
    const auto coordinate = [&](std::size_t axis) {
      return static_cast<double>(LoadAt<float>(bytes.data() + begin + 12 * i + 4 * axis));
    };
    const double x = coordinate(0);
    const double y = coordinate(1);
    num_seen += LooksThere(rows, DegFromRad(std::atan2(y, x)),
                           DegFromRad(std::atan2(coordinate(2), std::hypot(x, y))));
  }
  RecordProperty("seen", std::to_string(num_seen));
  EXPECT_GT(num_seen, kPoints * 99 / 100);
}

TEST(At128Sweep, SaysWhatIsWrong) {
  const auto said = [](std::uint32_t frames, double rate_hz) {
    ScanSpec scan = ReadSensor("at128");
    std::get<FiringTableSpec>(scan.pattern).frames = frames;
    scan.rate_hz = rate_hz;
    return FaultsOf(scan);
  };
  EXPECT_EQ(said(1, 10.0), "/pattern/frames: must be 3, the mirrors of an AT128 (got 1)");
  EXPECT_EQ(said(3, 0.5), "/rate_hz: must be >= 1 and <= 100 with an AT128's file (got 0.5)");
  EXPECT_EQ(said(3, 0.0), "/rate_hz: must be >= 0.01 and <= 1000000 (got 0)") << "said once";
  const TemporaryDirectory folder;
  const std::string cut = (folder.path() / "cut.dat").string();
  std::ofstream(cut) << "\xEE\xFF";
  EXPECT_EQ(FaultsOf({.rate_hz = 10.0, .pattern = FiringTableSpec{cut, 3}}),
            "/pattern/file: " + cut + ": must be 47176 bytes (got 2)");
}

// Any bit: of a shift by 0.01 deg, a start, an angle, what is not used, and the hash itself.
TEST(At128Correction, ThatIsDamagedIsRefused) {
  const TemporaryDirectory folder;
  const std::string file = (folder.path() / "unit.dat").string();
  const std::string whole = ReadFileWhole(RAILCAST_SOURCE_DIR "/scenarios/sensors/at128.dat");
  const auto write = [&](const std::string& bytes) {
    std::ofstream(file, std::ios::binary) << bytes;
  };
  write(whole);
  EXPECT_NO_THROW(static_cast<void>(ReadAt128Correction(file)));
  for (const std::size_t place : {7U, 16U, 40U, 600U, 1064U, 30'000U, 47'143U, 47'144U, 47'175U}) {
    std::string damaged = whole;
    damaged[place] = static_cast<char>(damaged[place] ^ 1);
    write(damaged);
    EXPECT_EQ(MessageOf([&] { static_cast<void>(ReadAt128Correction(file)); }),
              file + ": is damaged: its last 32 bytes must be the SHA-256 of those before")
        << place;
  }
}

}  // namespace
}  // namespace railcast
