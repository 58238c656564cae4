#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <limits>
#include <numbers>
#include <string>
#include <vector>

#include "railcast/error.h"
#include "railcast/lidar.h"
#include "tests/core/io/message_of.h"
#include "tests/core/scan/pattern_angles.h"

namespace railcast {
namespace {

std::int64_t StampNs(double rate_hz, std::uint32_t frame_index) {
  ScanPattern pattern;
  pattern.rate_hz = rate_hz;
  return pattern.StampNs(frame_index);
}

TEST(ScanPattern, StampsFramesOnePeriodApart) {
  EXPECT_EQ(StampNs(10.0, 0), 0);
  EXPECT_EQ(StampNs(10.0, 1), 100'000'000);
  EXPECT_EQ(StampNs(10.0, 36000), 3'600'000'000'000);
}

TEST(ScanPattern, StampsDoNotDriftWhereThePeriodIsNoWholeNumberOfNanoseconds) {
  EXPECT_EQ(StampNs(3.0, 1), 333'333'333);
  EXPECT_EQ(StampNs(3.0, 2), 666'666'667);
  EXPECT_EQ(StampNs(3.0, 3'000'000'000), 1'000'000'000'000'000'000);
}

TEST(ScanPattern, StampsAreExactForBrokenRates) {
  EXPECT_EQ(StampNs(12.5, 1), 80'000'000);
  EXPECT_EQ(StampNs(12.5, 4'000'000'001), 320'000'000'080'000'000);
  EXPECT_EQ(StampNs(0.5, std::numeric_limits<std::uint32_t>::max()), 8'589'934'590'000'000'000);
}

TEST(ScanPattern, StampsFramesFromThePhaseOn) {
  const ScanPattern pattern =
      BuildScanPattern({.rate_hz = 3.0, .pattern = RasterSpec{10.0, 10.0, 1.0}, .phase_s = 0.25});
  EXPECT_EQ(pattern.StampNs(0), 250'000'000);
  EXPECT_EQ(pattern.StampNs(1), 583'333'333);
  EXPECT_EQ(pattern.PeriodNs(), 333'333'333);
}

TEST(ScanPattern, BeginsWithinItsFirstPeriod) {
  const auto error_of = [](double phase_s) -> std::string {
    return MessageOf([&] {
      static_cast<void>(BuildScanPattern(
          {.rate_hz = 4.0, .pattern = RasterSpec{10.0, 10.0, 1.0}, .phase_s = phase_s}));
    });
  };
  EXPECT_EQ(error_of(0.25), "/phase_s: must be >= 0 and < 1 / rate_hz (got 0.25)");
  EXPECT_EQ(error_of(-0.01), "/phase_s: must be >= 0 and < 1 / rate_hz (got -0.01)");
}

TEST(ScanPattern, NamesTheLastFrameWhoseTimesFitInto64Bits) {
  constexpr std::uint32_t kMost = std::numeric_limits<std::uint32_t>::max();
  ScanPattern pattern;
  pattern.rate_hz = 10.0;
  EXPECT_EQ(pattern.LastFrame(), kMost);
  pattern.rate_hz = 0.125;
  // 2^63 - 2^32 ns are 9223372032.56 s.
  EXPECT_EQ(pattern.LastFrame(), 1'152'921'504U);
  EXPECT_EQ(pattern.StampNs(1'152'921'504), 9'223'372'032'000'000'000);
}

/// Azimuth and elevation range of a packet.
struct Extent {
  double azimuth_deg{};
  double elevation_deg{};
};

Extent ExtentOfPacket(const ScanPattern& pattern, std::size_t packet) {
  const std::uint32_t first = pattern.packet_order[packet * kPacketSize];
  double left_deg = 0.0;
  double right_deg = 0.0;
  double low_deg = 90.0;
  double high_deg = -90.0;
  for (std::size_t lane = 0; lane < kPacketSize; ++lane) {
    const std::uint32_t i = pattern.packet_order[packet * kPacketSize + lane];
    const double azimuth_deg =
        std::remainder(AzimuthInDegrees(pattern, i) - AzimuthInDegrees(pattern, first), 360.0);
    left_deg = std::max(left_deg, azimuth_deg);
    right_deg = std::min(right_deg, azimuth_deg);
    low_deg = std::min(low_deg, ElevationInDegrees(pattern, i));
    high_deg = std::max(high_deg, ElevationInDegrees(pattern, i));
  }
  return {left_deg - right_deg, high_deg - low_deg};
}

/// Checks the guarantees of ScanPattern::packet_order.
void ExpectEveryFiringOnce(const ScanPattern& pattern) {
  const std::size_t num_firings = pattern.num_firings();
  ASSERT_EQ(pattern.packet_order.size(), (num_firings + 15) / 16 * 16);
  for (std::size_t i = num_firings; i < pattern.packet_order.size(); ++i) {
    EXPECT_EQ(pattern.packet_order[i], pattern.packet_order[num_firings - 1]);
  }
  std::vector<std::uint32_t> sorted(
      pattern.packet_order.begin(),
      pattern.packet_order.begin() + static_cast<std::ptrdiff_t>(num_firings));
  std::ranges::sort(sorted);
  for (std::uint32_t i = 0; i < num_firings; ++i) ASSERT_EQ(sorted[i], i);
}

ScanPattern Raster(double width_deg, double height_deg, double step_deg) {
  return BuildScanPattern({.rate_hz = 10.0,
                           .pattern = RasterSpec{.horizontal_fov_deg = width_deg,
                                                 .vertical_fov_deg = height_deg,
                                                 .angular_resolution_deg = step_deg}});
}

TEST(PacketOrder, CutsTheRasterIntoBlocksOfFourByFour) {
  const ScanPattern pattern = Raster(60.0, 30.0, 0.25);
  ExpectEveryFiringOnce(pattern);
  for (std::size_t packet = 0; packet < 1800; ++packet) {
    const Extent extent = ExtentOfPacket(pattern, packet);
    ASSERT_NEAR(extent.azimuth_deg, 0.75, 2.0 * kFloatAngle_deg);
    ASSERT_NEAR(extent.elevation_deg, 0.75, 2.0 * kFloatAngle_deg);
  }
}

TEST(PacketOrder, FillsEveryPacketWhereBlocksDoNotFit) {
  for (const double width_deg : {1.0, 2.0, 5.0, 7.0, 33.0}) {
    for (const double height_deg : {1.0, 3.0, 9.0, 22.0}) {
      SCOPED_TRACE(testing::Message() << width_deg << " x " << height_deg);
      ExpectEveryFiringOnce(Raster(width_deg, height_deg, 1.0));
    }
  }
}

TEST(PacketOrder, KeepsPacketsTogetherWhereBlocksDoNotFit) {
  const ScanPattern pattern = Raster(61.0, 31.0, 1.0);
  for (std::size_t packet = 0; packet < pattern.packet_order.size() / kPacketSize; ++packet) {
    const Extent extent = ExtentOfPacket(pattern, packet);
    // A packet at the end of a band of four rows continues in the next band. The last band is three
    // rows high, so its packets are six columns wide.
    ASSERT_LE(extent.azimuth_deg, 6.0);
    ASSERT_LE(extent.elevation_deg, 7.0 + kFloatAngle_deg);
  }
}

TEST(PacketOrder, KeepsPacketsOfASpinningSensorWithAzimuthOffsetsTogether) {
  // 32 channels 1 deg apart, with azimuth offsets that differ by up to 9 deg; 0.2 deg per cycle.
  SpinningSpec spec{.channels = {}, .cycle_us = 100000.0 / 1800.0, .columns = 1800};
  for (int i = 0; i < 32; ++i) {
    spec.channels.push_back({.elevation_deg = i - 16.0, .azimuth_deg = 3.0 * (i % 4) - 4.5});
  }
  const ScanPattern pattern = BuildScanPattern({.rate_hz = 10.0, .pattern = spec});
  ExpectEveryFiringOnce(pattern);
  // Bands of round(sqrt(16 x 57600 x 369 / 31) / 1800) = 2 rows: 8 cycles wide. At the ends of a
  // turn, where only one row of the band extends over 3 deg, packets are twice as wide.
  std::size_t num_wide = 0;
  const std::size_t num_packets = pattern.packet_order.size() / kPacketSize;
  for (std::size_t packet = 0; packet < num_packets; ++packet) {
    const Extent extent = ExtentOfPacket(pattern, packet);
    ASSERT_LE(extent.azimuth_deg, 3.2);
    ASSERT_LE(extent.elevation_deg, 3.0 + kFloatAngle_deg);
    if (extent.azimuth_deg > 1.7 || extent.elevation_deg > 1.0 + kFloatAngle_deg) ++num_wide;
  }
  EXPECT_LT(num_wide, num_packets / 50);
}

TEST(PacketOrder, KeepsPacketsOfAScatteredTableTogether) {
  // A Lissajous figure, 40 x 20 deg: firings adjacent in time are not adjacent in angle.
  const std::string file = testing::TempDir() + "lissajous.csv";
  constexpr int kFirings = 10000;
  constexpr std::size_t kPackets = kFirings / kPacketSize;
  {
    std::ofstream table(file);
    table << "azimuth_deg,elevation_deg,time_us\n";
    for (int i = 0; i < kFirings; ++i) {
      const double phase = 2.0 * std::numbers::pi * i / kFirings;
      table << 20.0 * std::sin(997.0 * phase) << ',' << 10.0 * std::sin(1009.0 * phase) << ','
            << 9 * i << '\n';
    }
  }
  const ScanPattern pattern = BuildScanPattern({.rate_hz = 10.0, .pattern = FiringTableSpec{file}});
  ExpectEveryFiringOnce(pattern);
  double sum_deg = 0.0;
  for (std::size_t packet = 0; packet < kPackets; ++packet) {
    const Extent extent = ExtentOfPacket(pattern, packet);
    sum_deg += std::max(extent.azimuth_deg, extent.elevation_deg);
  }
  // 16 firings of 10000 cover, on average, a square of sqrt(16 x 800 / 10000) = 1.13 deg.
  EXPECT_LT(sum_deg, 2.0 * 1.13 * kPackets);
}

/// Expects that the firing of every slot has the slot's row and column, and that no two firings
/// share a slot.
void ExpectFiringsOfAllSlots(const ScanPattern& pattern, std::uint32_t returns) {
  std::vector<std::uint32_t> num_slots(pattern.num_firings());
  for (std::size_t slot = 0; slot < std::size_t{returns} * pattern.num_firings(); ++slot) {
    const std::uint32_t firing = FiringOfSlot(pattern, returns, slot);
    ASSERT_LT(firing, num_slots.size());
    const std::size_t first =
        (std::size_t{pattern.row[firing]} * pattern.columns + pattern.column[firing]) * returns;
    ASSERT_GE(slot, first);
    ASSERT_LT(slot, first + returns);
    ++num_slots[firing];
  }
  EXPECT_EQ(num_slots, std::vector<std::uint32_t>(pattern.num_firings(), returns));
}

TEST(FiringOfSlot, FindsTheColumnsOfARasterInWhateverOrderTheyFire) {
  for (const RasterOrder order : {RasterOrder::kColumns, RasterOrder::kRows}) {
    const ScanPattern pattern =
        BuildScanPattern({.rate_hz = 10.0, .pattern = RasterSpec{6.0, 4.0, 1.0, order}});
    ExpectFiringsOfAllSlots(pattern, 1);
  }
  // Six columns of four rows each; columns fire one after another.
  const ScanPattern pattern =
      BuildScanPattern({.rate_hz = 10.0, .pattern = RasterSpec{6.0, 4.0, 1.0}});
  EXPECT_EQ(FiringOfSlot(pattern, 1, 1), 4U);
  EXPECT_EQ(FiringOfSlot(pattern, 1, 6), 1U);
}

TEST(FiringOfSlot, FindsTheChannelsOfASpinningSensorWithSeveralReturns) {
  // Rows are ordered by elevation: the channel that fires first is the highest.
  const SpinningSpec spinning{.channels = {{.elevation_deg = 5.0, .time_us = 0.0},
                                           {.elevation_deg = -10.0, .time_us = 25.0},
                                           {.elevation_deg = 0.0, .time_us = 50.0}},
                              .cycle_us = 100.0,
                              .columns = 20};
  const ScanPattern pattern = BuildScanPattern({.rate_hz = 10.0, .pattern = spinning});
  for (const std::uint32_t returns : {1U, 2U, 3U}) ExpectFiringsOfAllSlots(pattern, returns);
  EXPECT_EQ(FiringOfSlot(pattern, 2, 0), 1U);
  EXPECT_EQ(FiringOfSlot(pattern, 2, 2 * 20 * 2 + 1), 0U);
}

TEST(FiringOfSlot, CountsAlongTheTableOfAPatternThatIsNoGrid) {
  const std::string file = testing::TempDir() + "firing_of_slot.csv";
  std::ofstream(file) << "azimuth_deg,elevation_deg,time_us\n10,-5,0\n-20,7,12.5\n0,0,12.5\n";
  const ScanPattern pattern = BuildScanPattern({.rate_hz = 10.0, .pattern = FiringTableSpec{file}});
  std::filesystem::remove(file);
  EXPECT_EQ(FiringOfSlot(pattern, 1, 2), 2U);
  EXPECT_EQ(FiringOfSlot(pattern, 3, 5), 1U);
}

}  // namespace
}  // namespace railcast
