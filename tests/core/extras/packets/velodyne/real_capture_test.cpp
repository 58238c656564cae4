#include <gtest/gtest.h>
#include <pcl/io/pcd_io.h>
#include <pcl/point_types.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <iterator>
#include <map>
#include <ostream>

#include "core/base/units.h"
#include "core/extras/packets/pcap/pcap_reader.h"
#include "core/extras/packets/spinning/spinning_decoder.h"
#include "core/scenario/sensors.h"
#include "railcast/transform.h"
#include "tests/support/decode_packet.h"
#include "tests/support/pcl_reads.h"

namespace railcast {
namespace {

std::filesystem::path VelodyneCapture(const char* name) {
  return std::filesystem::path(RAILCAST_SHARED_DATA_DIR "/lidar_packets_nebula") / name;
}
constexpr double kHalfTurn_deg = 180.0;

std::vector<SensorTurn> DecodeCapture(const std::filesystem::path& file,
                                      const SpinningModel& model) {
  PcapReader reader(file);
  SpinningDecoder decoder(model);
  std::vector<SensorTurn> turns;
  while (const auto datagram = reader.Next()) {
    EXPECT_EQ(datagram->destination_port, kVelodyneDataPort);
    EXPECT_EQ(DecodePacket(decoder, datagram->payload, turns), std::nullopt);
  }
  turns.push_back(decoder.TakeUnfinished());
  return turns;
}

/// A point in the axes of the file (x forward, y left), as the packet must have held it.
struct Measured {
  std::uint8_t laser{};
  long distance{};  ///< In the packet's unit.
  double azimuth_deg{};
};

Measured MeasuredOf(const pcl::PointXYZ& point, const SpinningModel& model) {
  const Vector3 place_m(static_cast<double>(point.x), static_cast<double>(point.y),
                        static_cast<double>(point.z));
  const double range_m = place_m.norm();
  const double elevation_deg = DegFromRad(std::asin(place_m.z() / range_m));
  const auto laser = std::ranges::min_element(model.channels, {}, [&](const ChannelSpec& channel) {
    return std::abs(channel.elevation_deg - elevation_deg);
  });
  return {.laser = static_cast<std::uint8_t>(laser - model.channels.begin()),
          .distance = std::lround(range_m / (1e-3 * model.unit_mm)),
          .azimuth_deg = -DegFromRad(std::atan2(place_m.y(), place_m.x()))};
}

double Difference_deg(double a_deg, double b_deg) {
  return std::abs(std::remainder(a_deg - b_deg, 2.0 * kHalfTurn_deg));
}

/// How another decoder's points compare with ours of the same laser and the same distance.
struct Comparison {
  /// Share of their points that match one of ours under either rule of LeftOver_deg.
  double matched_share{};
  /// Share of their points that match only under the rule for the last block of a packet.
  double last_block_share{};
  double median_deg{};  ///< Between azimuths, after applying their rule to both.
  double max_deg{};
  double median_mm{};  ///< Between positions without correction.
  double max_mm{};
};

/// When Nebula takes a laser to fire, since the start of its cycle.
double TheirTime_us(std::uint8_t laser, const SpinningModel& model) {
  // 2.304 us x laser, also for VLP-32C, whose lasers fire in pairs.
  return model.blocks_per_loop() == 1 ? 2.304 * laser : model.channels[laser].time_us;
}

/// Nebula turns a laser's azimuth until TheirTime_us(), except in the last block of a packet, where
/// it does not turn it. Returns the difference that remains under either rule.
std::pair<double, double> LeftOver_deg(double their_deg,
                                       const TurnPoint& ours,
                                       const SpinningModel& model) {
  constexpr double kTurn_deg_per_us = 3600e-6;  // The captures were made at 600 rpm.
  const double our_time_us = model.channels[ours.laser].time_us;
  const double late_us =
      ours.return_index * model.cycle_us * static_cast<double>(model.cycles_per_block());
  const double apart_deg =
      their_deg - kTurn_deg_per_us * late_us - DegFromRad(static_cast<double>(ours.azimuth_rad));
  const double earlier_us = TheirTime_us(ours.laser, model) - our_time_us;
  const double turned_deg = Difference_deg(apart_deg, kTurn_deg_per_us * earlier_us);
  double still_deg = kHalfTurn_deg;
  for (std::size_t cycle = 0; cycle < model.cycles_per_block(); ++cycle) {
    const double time_us = our_time_us + static_cast<double>(cycle) * model.cycle_us;
    still_deg = std::min(still_deg, Difference_deg(apart_deg, -kTurn_deg_per_us * time_us));
  }
  return {turned_deg, still_deg};
}

Comparison Compare(const pcl::PointCloud<pcl::PointXYZ>& theirs,
                   const std::vector<TurnPoint>& ours,
                   const SpinningModel& model) {
  // The packet and the other decoder both round azimuths to 0.01 deg, and so is the step to the
  // next block rounded, from which that decoder derives the speed.
  constexpr double kTolerance_deg = 0.04;
  std::map<std::pair<std::uint8_t, long>, std::vector<TurnPoint>> by_measurement;
  for (const TurnPoint& point : ours) {
    const long distance = std::lround(static_cast<double>(point.range_m) / (1e-3 * model.unit_mm));
    by_measurement[{point.laser, distance}].push_back(point);
  }
  std::size_t num_last_block = 0;
  std::vector<double> angles_deg;
  std::vector<double> distances_mm;
  for (const pcl::PointXYZ& point : theirs) {
    const Measured measured = MeasuredOf(point, model);
    double nearest_deg = kTolerance_deg;
    double nearest_mm = 0.0;
    bool is_last_block = false;
    for (const TurnPoint& candidate : by_measurement[{measured.laser, measured.distance}]) {
      const auto [turned_deg, still_deg] = LeftOver_deg(measured.azimuth_deg, candidate, model);
      if (std::min(turned_deg, still_deg) >= nearest_deg) continue;
      nearest_deg = std::min(turned_deg, still_deg);
      is_last_block = turned_deg >= kTolerance_deg;
      const Eigen::Vector3f apart_m(candidate.x - point.x, candidate.y - point.y,
                                    candidate.z - point.z);
      nearest_mm = 1e3 * static_cast<double>(apart_m.norm());
    }
    if (nearest_deg == kTolerance_deg) continue;
    num_last_block += is_last_block ? 1U : 0U;
    angles_deg.push_back(nearest_deg);
    distances_mm.push_back(nearest_mm);
  }
  std::ranges::sort(angles_deg);
  std::ranges::sort(distances_mm);
  const auto share = [&](std::size_t count) {
    return static_cast<double>(count) / static_cast<double>(theirs.size());
  };
  return {.matched_share = share(angles_deg.size()),
          .last_block_share = share(num_last_block),
          .median_deg = angles_deg.at(angles_deg.size() / 2),
          .max_deg = angles_deg.back(),
          .median_mm = distances_mm[distances_mm.size() / 2],
          .max_mm = distances_mm.back()};
}

std::ostream& operator<<(std::ostream& out, const Comparison& c) {
  return out << "matched " << 100.0 * c.matched_share << " %, " << 100.0 * c.last_block_share
             << " % as of the last block; azimuths: median " << c.median_deg << " deg, max "
             << c.max_deg << " deg; positions: median " << c.median_mm << " mm, max " << c.max_mm
             << " mm";
}

TEST(RealCapture, DecodesVlp16InDualModeAsNebulaDoes) {
  const auto file = VelodyneCapture("vlp16_dual.pcap");
  if (!exists(file)) GTEST_SKIP() << file << " is not there";
  const SpinningModel& model = *FindSpinningModel("vlp16");
  const auto turns = DecodeCapture(file, model);
  const auto theirs =
      PclReads<pcl::PointCloud<pcl::PointXYZ>>(VelodyneCapture("vlp16_dual_decoded.pcd"));
  ASSERT_EQ(theirs.size(), 14'831U);
  // The capture holds four turns and the first firings of a fifth; the published cloud is the
  // fourth.
  ASSERT_EQ(turns.size(), 5U);
  const Comparison comparison = Compare(theirs, turns[3].points, model);
  EXPECT_GT(comparison.matched_share, 0.997) << comparison;
  EXPECT_LT(comparison.last_block_share, 1.0 / 6.0) << comparison;
  EXPECT_LT(comparison.median_deg, 0.005) << comparison;  // Half of a packet's resolution.
  EXPECT_LT(comparison.median_mm, 1.0) << comparison;     // Half a unit.
}

TEST(RealCapture, DecodesVlp32cAsNebulaDoes) {
  const auto file = VelodyneCapture("vlp32c_single.pcap");
  if (!exists(file)) GTEST_SKIP() << file << " is not there";
  const SpinningModel& model = *FindSpinningModel("vlp32c");
  const auto turns = DecodeCapture(file, model);
  const auto theirs =
      PclReads<pcl::PointCloud<pcl::PointXYZ>>(VelodyneCapture("vlp32c_single_decoded.pcd"));
  ASSERT_EQ(theirs.size(), 26'216U);
  // The sensor scanned from 270 to 91 deg; the published cloud is the first such sector, in which
  // the azimuth passes 0. It ends with a packet, of which four blocks are of the next sector.
  constexpr std::int64_t kHalfTurn_ns = 50'000'000;
  const auto num_columns =
      4 + std::ranges::count_if(turns[1].column_time_ns,
                                [](std::int64_t time_ns) { return time_ns < kHalfTurn_ns; });
  std::vector<TurnPoint> sector = turns[0].points;
  std::ranges::copy_if(turns[1].points, std::back_inserter(sector),
                       [&](const TurnPoint& point) { return point.column < num_columns; });
  const Comparison comparison = Compare(theirs, sector, model);
  EXPECT_EQ(comparison.matched_share, 1.0) << comparison;
  EXPECT_LT(comparison.last_block_share, 1.0 / 12.0) << comparison;
  EXPECT_LT(comparison.median_deg, 0.005) << comparison;
  // Nebula's firing times turn the median laser of this sensor by a further 0.07 deg, at 5 m.
  EXPECT_LT(comparison.median_mm, 6.0) << comparison;
}

// Four of its packets hold blocks before and behind the gap of the window, in which the rotor turns
// on for 900 firing cycles. The packet after each says when it begins, and so when these blocks
// were.
TEST(RealCapture, HasTheTimesOfTheBlocksBehindTheGapOfItsWindow) {
  const auto file = VelodyneCapture("vlp32c_single.pcap");
  if (!exists(file)) GTEST_SKIP() << file << " is not there";
  std::size_t num_gaps = 0;
  for (const SensorTurn& turn : DecodeCapture(file, *FindSpinningModel("vlp32c"))) {
    for (std::size_t i = 1; i < turn.num_columns(); ++i) {
      const double cycles =
          static_cast<double>(turn.column_time_ns[i] - turn.column_time_ns[i - 1]) / 55'296.0;
      const bool is_gap = cycles > 100.0;
      num_gaps += is_gap ? 1 : 0;
      // To within a cycle, and the microsecond that packets state.
      ASSERT_NEAR(cycles, is_gap ? 900.0 : 1.0, 1.05) << i;
    }
  }
  EXPECT_EQ(num_gaps, 5U);
}

// The published cloud is the second turn, the first whole one. Nebula derives the speed from the
// step to the next block, which is 0 for three of the four blocks of a cycle: it does not turn
// them.
TEST(RealCapture, DecodesVls128AsNebulaDoes) {
  const auto file = VelodyneCapture("vls128_single.pcap");
  if (!exists(file)) GTEST_SKIP() << file << " is not there";
  const SpinningModel& model = ModelNamed("VLS-128");
  const auto turns = DecodeCapture(file, model);
  const auto theirs =
      PclReads<pcl::PointCloud<pcl::PointXYZ>>(VelodyneCapture("vls128_single_decoded.pcd"));
  ASSERT_EQ(theirs.size(), 208'680U);
  ASSERT_EQ(turns.size(), 5U);
  const Comparison comparison = Compare(theirs, turns[1].points, model);
  EXPECT_GT(comparison.matched_share, 0.999) << comparison;
  EXPECT_LT(comparison.last_block_share, 3.0 / 4.0) << comparison;
  EXPECT_LT(comparison.median_deg, 0.005) << comparison;
  EXPECT_LT(comparison.median_mm, 18.0) << comparison;  // Half a cycle's turn, 0.08 deg, at 12 m.
}

}  // namespace
}  // namespace railcast
