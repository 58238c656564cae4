#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <limits>
#include <vector>

#include "tests/core/scan/pattern_angles.h"

namespace railcast {
namespace {

/// Three channels, not in order of elevation; 1000 cycles of 100 us fill a turn at 10 Hz: 0.36 deg
/// per cycle.
SpinningSpec ThreeChannels() {
  return {.channels = {{.elevation_deg = 5.0, .azimuth_deg = 0.0, .time_us = 0.0},
                       {.elevation_deg = -10.0, .azimuth_deg = 1.5, .time_us = 25.0},
                       {.elevation_deg = 0.0, .azimuth_deg = -2.0, .time_us = 25.0}},
          .cycle_us = 100.0,
          .columns = 1000};
}

std::string FaultsOf(const SpinningSpec& spec) {
  return FaultsOf(ScanSpec{.rate_hz = 10.0, .pattern = spec});
}

double Wrapped(double angle_deg) {
  return std::remainder(angle_deg, 360.0);
}

TEST(SpinningPattern, SortsRowsByElevationFromTheLowest) {
  const ScanPattern pattern = BuildScanPattern({.rate_hz = 10.0, .pattern = ThreeChannels()});
  EXPECT_EQ(pattern.rows, 3U);
  EXPECT_EQ(pattern.columns, 1000U);
  constexpr double kElevations_deg[] = {-10.0, 0.0, 5.0};
  for (std::size_t i = 0; i < pattern.num_firings(); ++i) {
    ASSERT_NEAR(ElevationInDegrees(pattern, i), kElevations_deg[pattern.row[i]], kFloatAngle_deg);
  }
}

TEST(SpinningPattern, OrdersFiringsByTimeThenRow) {
  const ScanPattern pattern = BuildScanPattern({.rate_hz = 10.0, .pattern = ThreeChannels()});
  constexpr std::uint16_t kRows[] = {2, 0, 1};
  constexpr std::uint32_t kTimes_ns[] = {0, 25000, 25000};
  for (std::size_t i = 0; i < pattern.num_firings(); ++i) {
    ASSERT_EQ(pattern.row[i], kRows[i % 3]);
    ASSERT_EQ(pattern.column[i], i / 3);
    ASSERT_EQ(pattern.time_ns[i], 100000 * (i / 3) + kTimes_ns[i % 3]);
  }
}

TEST(SpinningPattern, AimsWhereTheRotorIsAtTheFiringsOwnTime) {
  const ScanPattern pattern = BuildScanPattern({.rate_hz = 10.0, .pattern = ThreeChannels()});
  constexpr double kOffsets_deg[] = {1.5, -2.0, 0.0};
  for (std::size_t i = 0; i < pattern.num_firings(); ++i) {
    const double clockwise_deg = 3600.0 * 1e-9 * pattern.time_ns[i] + kOffsets_deg[pattern.row[i]];
    ASSERT_NEAR(Wrapped(AzimuthInDegrees(pattern, i) + clockwise_deg), 0.0, kFloatAngle_deg);
  }
}

TEST(SpinningPattern, TurnsLeftFromItsStartWhereAskedTo) {
  SpinningSpec spec = ThreeChannels();
  spec.rotation = Rotation::kCounterclockwise;
  spec.start_azimuth_deg = 30.0;
  const ScanPattern pattern = BuildScanPattern({.rate_hz = 10.0, .pattern = spec});
  EXPECT_NEAR(AzimuthInDegrees(pattern, 0), 30.0, kFloatAngle_deg);
  EXPECT_NEAR(AzimuthInDegrees(pattern, 1), 30.0 + 0.09 + 1.5, kFloatAngle_deg);
  EXPECT_NEAR(AzimuthInDegrees(pattern, 3), 30.36, kFloatAngle_deg);
}

/// What a pattern does at each of its firings.
std::vector<std::array<float, 4>> FiringsOf(const ScanPattern& pattern) {
  std::vector<std::array<float, 4>> firings;
  for (std::size_t i = 0; i < pattern.num_firings(); ++i) {
    firings.push_back({pattern.direction_x[i], pattern.direction_y[i], pattern.direction_z[i],
                       static_cast<float>(pattern.time_ns[i])});
  }
  return firings;
}

TEST(SpinningPattern, FiresInItsWindowAsItWouldWithoutOne) {
  const ScanPattern whole = BuildScanPattern({.rate_hz = 10.0, .pattern = ThreeChannels()});
  SpinningSpec spec = ThreeChannels();
  spec.azimuth_window_deg = {{36.0, 72.0}};
  const ScanPattern window = BuildScanPattern({.rate_hz = 10.0, .pattern = spec});
  // 0.36 deg a cycle: the window begins with cycle 100, and cycle 200 begins where it ends.
  EXPECT_EQ(window.columns, 100U);
  ASSERT_EQ(window.num_firings(), 300U);
  const auto all = FiringsOf(whole);
  EXPECT_EQ(FiringsOf(window), std::vector(all.begin() + 300, all.begin() + 600));
  EXPECT_EQ(window.column.back(), 99U);
}

TEST(SpinningPattern, FiresOnBothSidesOfZeroIfItsWindowBeginsBefore) {
  const ScanPattern whole = BuildScanPattern({.rate_hz = 10.0, .pattern = ThreeChannels()});
  SpinningSpec spec = ThreeChannels();
  spec.azimuth_window_deg = {{324.0, 36.0}};
  const ScanPattern window = BuildScanPattern({.rate_hz = 10.0, .pattern = spec});
  auto expected = FiringsOf(whole);
  expected.erase(expected.begin() + 300, expected.begin() + 2700);
  EXPECT_EQ(FiringsOf(window), expected);
  // Begun where the window does, the frame is of one piece.
  spec.start_azimuth_deg = 324.0;
  const ScanPattern piece = BuildScanPattern({.rate_hz = 10.0, .pattern = spec});
  EXPECT_EQ(piece.columns, 200U);
  EXPECT_EQ(piece.time_ns.back(), 19'925'000U);
}

TEST(SpinningPattern, RefusesWindowsThatCannotBe) {
  const auto faults_of = [](double begin_deg, double end_deg) {
    SpinningSpec spec = ThreeChannels();
    spec.azimuth_window_deg = {{begin_deg, end_deg}};
    return FaultsOf(spec);
  };
  EXPECT_EQ(faults_of(-1.0, 370.0),
            "/pattern/azimuth_window_deg/0: must be >= 0 and <= 360 (got -1)\n"
            "/pattern/azimuth_window_deg/1: must be >= 0 and <= 360 (got 370)");
  EXPECT_EQ(faults_of(90.0, 90.0),
            "/pattern/azimuth_window_deg: must begin and end at two azimuths (got 90)");
  EXPECT_EQ(faults_of(0.1, 0.3),
            "/pattern/azimuth_window_deg: must have the begin of a firing cycle");
}

TEST(SpinningPattern, RefusesChannelsThatCannotBe) {
  SpinningSpec spec = ThreeChannels();
  spec.channels[0].elevation_deg = 91.0;
  spec.channels[1].time_us = 100.0;
  spec.channels[2].azimuth_deg = std::numeric_limits<double>::quiet_NaN();
  EXPECT_EQ(FaultsOf(spec),
            "/pattern/channels/0/elevation_deg: must be >= -90 and <= 90 (got 91)\n"
            "/pattern/channels/1/time_us: must be >= 0 and < cycle_us (got 100)\n"
            "/pattern/channels/2/azimuth_deg: must be >= -360 and <= 360 (got nan)");
}

TEST(SpinningPattern, RefusesPatternsWithoutFirings) {
  SpinningSpec spec = ThreeChannels();
  spec.channels.clear();
  spec.columns = 0;
  EXPECT_EQ(FaultsOf(spec),
            "/pattern/channels: must have at least one channel (got 0)\n"
            "/pattern/columns: must be > 0 (got 0)");
}

TEST(SpinningPattern, RefusesTurnsThatLastLongerThanThePeriod) {
  SpinningSpec spec = ThreeChannels();
  spec.columns = 1001;
  EXPECT_EQ(FaultsOf(spec),
            "/pattern/columns: columns x cycle_us must be <= 1 / rate_hz (got 100100)");
}

TEST(SpinningPattern, RefusesWhatIsNoCycleAndNoStart) {
  SpinningSpec spec = ThreeChannels();
  spec.start_azimuth_deg = 400.0;
  spec.cycle_us = 0.0;
  EXPECT_EQ(FaultsOf(spec),
            "/pattern/start_azimuth_deg: must be >= -360 and <= 360 (got 400)\n"
            "/pattern/cycle_us: must be > 0 (got 0)");
}

TEST(SpinningPattern, RefusesACycleThatStartsWithoutAFiring) {
  SpinningSpec spec = ThreeChannels();
  spec.channels[0].time_us = 10.0;
  EXPECT_EQ(FaultsOf(spec), "/pattern/channels: the earliest time_us must be 0 (got 10)");
}

TEST(SpinningPattern, RefusesHugePatterns) {
  SpinningSpec spec = ThreeChannels();
  spec.cycle_us = 0.01;
  spec.columns = 10'000'000;
  spec.channels = {{}, {}};
  EXPECT_EQ(FaultsOf(spec), "/pattern: must have at most 16777216 firings (got 2e+07)");
}

ScanSpec Published() {
  return {
      .rate_hz = 10.0,
      .pattern = RasterSpec{
          .horizontal_fov_deg = 60.0, .vertical_fov_deg = 30.0, .angular_resolution_deg = 0.25}};
}

TEST(RasterPattern, HasThePublishedNumberOfBeams) {
  const ScanPattern pattern = BuildScanPattern(Published());
  EXPECT_EQ(pattern.rows, 120U);
  EXPECT_EQ(pattern.columns, 240U);
  EXPECT_EQ(pattern.num_firings(), 28800U);
}

TEST(RasterPattern, AimsThroughTheCentresOfTheCells) {
  const ScanPattern pattern = BuildScanPattern(Published());
  for (std::size_t i = 0; i < pattern.num_firings(); ++i) {
    ASSERT_NEAR(AzimuthInDegrees(pattern, i), 29.875 - 0.25 * pattern.column[i], kFloatAngle_deg);
    ASSERT_NEAR(ElevationInDegrees(pattern, i), -14.875 + 0.25 * pattern.row[i], kFloatAngle_deg);
  }
}

TEST(RasterPattern, FiresColumnsEvenlyOverThePeriodAndRowsTogether) {
  const ScanPattern pattern = BuildScanPattern(Published());
  for (std::size_t i = 0; i < pattern.num_firings(); ++i) {
    ASSERT_EQ(pattern.column[i], i / 120);
    ASSERT_EQ(pattern.row[i], i % 120);
    ASSERT_EQ(pattern.time_ns[i], std::lround(1e8 * pattern.column[i] / 240));
  }
  EXPECT_EQ(pattern.time_ns.back(), 99583333U);
}

TEST(RasterPattern, FiresRowsFromTheBottomWhereAskedTo) {
  ScanSpec spec = Published();
  std::get<RasterSpec>(spec.pattern).order = RasterOrder::kRows;
  const ScanPattern pattern = BuildScanPattern(spec);
  for (std::size_t i = 0; i < pattern.num_firings(); ++i) {
    ASSERT_EQ(pattern.row[i], i / 240);
    ASSERT_EQ(pattern.column[i], i % 240);
    ASSERT_EQ(pattern.time_ns[i], std::lround(1e8 * pattern.row[i] / 120));
  }
}

TEST(RasterPattern, HasDirectionsOfUnitLength) {
  const ScanPattern pattern = BuildScanPattern(Published());
  for (std::size_t i = 0; i < pattern.num_firings(); ++i) {
    ASSERT_NEAR(Direction(pattern, i).squaredNorm(), 1.0,
                1.2e-7);  // 2 x three roundings of at most 2^-25.
  }
}

TEST(RasterPattern, AcceptsDecimalResolutionsThatDivideTheFieldOfView) {
  const ScanPattern pattern = BuildScanPattern(
      {.rate_hz = 25.0,
       .pattern = RasterSpec{
           .horizontal_fov_deg = 360.0, .vertical_fov_deg = 0.3, .angular_resolution_deg = 0.1}});
  EXPECT_EQ(pattern.columns, 3600U);
  EXPECT_EQ(pattern.rows, 3U);
}

TEST(RasterPattern, RefusesCellsThatAreNotWhole) {
  EXPECT_EQ(
      railcast::FaultsOf({.rate_hz = 10.0,
                          .pattern = RasterSpec{.horizontal_fov_deg = 60.0,
                                                .vertical_fov_deg = 30.0,
                                                .angular_resolution_deg = 0.8}}),
      "/pattern/vertical_fov_deg: must be a whole number of angular_resolution_deg (got 37.5)");
}

TEST(RasterPattern, ReportsEveryFaultAtOnce) {
  EXPECT_EQ(railcast::FaultsOf({.rate_hz = 0.0,
                                .pattern = RasterSpec{.horizontal_fov_deg = 361.0,
                                                      .vertical_fov_deg = -1.0,
                                                      .angular_resolution_deg = 0.25}}),
            "/rate_hz: must be >= 0.01 and <= 1000000 (got 0)\n"
            "/pattern/horizontal_fov_deg: must be > 0 and <= 360 (got 361)\n"
            "/pattern/vertical_fov_deg: must be > 0 and <= 180 (got -1)");
  EXPECT_EQ(railcast::FaultsOf({.rate_hz = 10.0,
                                .pattern = RasterSpec{.horizontal_fov_deg = 60.0,
                                                      .vertical_fov_deg = 30.0,
                                                      .angular_resolution_deg = std::nan("")}}),
            "/pattern/angular_resolution_deg: must be > 0 (got nan)");
}

TEST(RasterPattern, RefusesHugePatterns) {
  EXPECT_EQ(railcast::FaultsOf({.rate_hz = 10.0,
                                .pattern = RasterSpec{.horizontal_fov_deg = 360.0,
                                                      .vertical_fov_deg = 180.0,
                                                      .angular_resolution_deg = 0.0001}}),
            "/pattern/vertical_fov_deg: must have at most 65536 cells (got 1800000)\n"
            "/pattern: must have at most 16777216 firings (got 6.48e+12)");
}

TEST(RasterPattern, RefusesFramesLongerThan32BitsOfNanoseconds) {
  ScanSpec spec = Published();
  spec.rate_hz = 0.2;
  EXPECT_EQ(FaultsOf(spec), "/pattern: the last firing must come before 4.29 s (got 4.979166667)");
}

}  // namespace
}  // namespace railcast
