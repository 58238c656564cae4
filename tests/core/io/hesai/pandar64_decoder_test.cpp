#include "core/io/hesai/pandar64_decoder.h"

#include <gtest/gtest.h>
#include <pcl/io/pcd_io.h>
#include <pcl/point_types.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <tuple>

#include "core/base/units.h"
#include "core/io/field_layout.h"
#include "core/io/hesai/pandar64_packet.h"
#include "core/io/pcap/pcap_reader.h"
#include "railcast/transform.h"
#include "tests/core/io/hesai/made_packet.h"
#include "tests/support/sensor_file.h"

namespace railcast {
namespace {

constexpr std::size_t kMode = kPandar64ModePlace;

SensorTurn Decoded(const std::vector<char>& packet) {
  Pandar64Decoder decoder;
  std::vector<SensorTurn> turns;
  EXPECT_EQ(decoder.Decode(packet, turns), std::nullopt);
  EXPECT_TRUE(turns.empty());
  return decoder.TakeUnfinished();
}

TEST(Pandar64Decoder, KnowsTheFactorysChannels) {
  const ScanSpec sensor = ReadSensor("pandar64");
  EXPECT_EQ(Pandar64Channels(), std::get<SpinningSpec>(sensor.pattern).channels);
}

TEST(Pandar64Decoder, PlacesAPointByItsBlockAndChannel) {
  const SensorTurn turn = Decoded(MadePacket());
  EXPECT_FALSE(turn.is_dual);
  ASSERT_EQ(turn.points.size(), 6U);
  ASSERT_EQ(turn.num_columns(), 6U);
  const TurnPoint& point = turn.points[2];
  EXPECT_EQ(point.column, 2U);
  EXPECT_EQ(point.ring, 63U);
  EXPECT_EQ(point.laser, 0U);
  EXPECT_EQ(point.intensity, 50U);
  EXPECT_FLOAT_EQ(point.range_m, 1.0F);
  const double azimuth_rad = RadFromDeg(1.4 - 1.042);
  const double elevation_rad = RadFromDeg(14.9);
  EXPECT_NEAR(point.x, std::cos(elevation_rad) * std::cos(azimuth_rad), 1e-6);
  EXPECT_NEAR(point.y, -std::cos(elevation_rad) * std::sin(azimuth_rad), 1e-6);
  EXPECT_NEAR(point.z, std::sin(elevation_rad), 1e-6);
}

// By HesaiLidar_SDK, the packet ends 42.58 us after its last block; channel 1 fires 23.18 us before
// the end of its block, and the earliest channel 54.668 us before it.
TEST(Pandar64Decoder, CountsTimeBackFromThePacketsEnd) {
  const SensorTurn turn = Decoded(MadePacket());
  const std::int64_t packet_ns = 86'403 * 1'000'000'000LL + 500'000'000;
  EXPECT_EQ(turn.stamp_ns, packet_ns - 42'580 - 277'800 - 54'668);
  EXPECT_EQ(turn.column_time_ns[5], 277'800);  // The time of five cycles.
  EXPECT_EQ(turn.stamp_ns + turn.points[5].time_ns, packet_ns - 42'580 - 23'180);
}

TEST(Pandar64Decoder, TakesTwoBlocksForOneCycleInDualMode) {
  std::vector<char> packet = MadePacket(kPandar64LastAndStrongest);
  // Only the returns of the second pair of blocks differ.
  StoreAt<std::uint16_t>(
      packet.data() + kPandar64HeaderSize + 3 * kPandar64BlockSize + sizeof(std::uint16_t), 200);
  const SensorTurn turn = Decoded(packet);
  EXPECT_TRUE(turn.is_dual);
  ASSERT_EQ(turn.num_columns(), 3U);
  EXPECT_EQ(turn.column_time_ns[2], 2 * 55'560);
  ASSERT_EQ(turn.points.size(), 4U);
  EXPECT_EQ(turn.points[1].return_index, 0U);
  EXPECT_FLOAT_EQ(turn.points[1].range_m, 1.0F);
  EXPECT_EQ(turn.points[2].return_index, 1U);
  EXPECT_EQ(turn.points[2].column, 1U);
  EXPECT_FLOAT_EQ(turn.points[2].range_m, 0.8F);
}

TEST(Pandar64Decoder, EndsATurnWhereTheAzimuthFalls) {
  Pandar64Decoder decoder;
  std::vector<SensorTurn> turns;
  for (int i = 0; i < 3; ++i) EXPECT_EQ(decoder.Decode(MadePacket(), turns), std::nullopt);
  EXPECT_EQ(turns.size(), 2U);
  EXPECT_EQ(turns.at(1).num_columns(), 6U);
}

TEST(Pandar64Decoder, CutsTheTurnOfARotorThatStandsStill) {
  std::vector<char> packet = MadePacket();
  for (std::size_t block = 0; block < 6; ++block) {
    StoreAt<std::uint16_t>(packet.data() + kPandar64HeaderSize + block * kPandar64BlockSize, 7);
  }
  Pandar64Decoder decoder;
  std::vector<SensorTurn> turns;
  for (int i = 0; turns.empty() && i < 10'000; ++i) {
    ASSERT_EQ(decoder.Decode(packet, turns), std::nullopt);
  }
  ASSERT_EQ(turns.size(), 1U);
  EXPECT_EQ(turns[0].num_columns(), std::size_t{1} << 14U);
}

template <typename Number>
std::string RefusalOfPacketWith(std::size_t place, Number number) {
  std::vector<char> packet = MadePacket(kPandar64LastAndStrongest);
  StoreAt<Number>(packet.data() + place, number);
  Pandar64Decoder decoder;
  std::vector<SensorTurn> turns;
  return decoder.Decode(packet, turns).value_or("");
}

TEST(Pandar64Decoder, RefusesWhatIsNoPacketOfIts) {
  using Byte = std::uint8_t;
  Pandar64Decoder decoder;
  std::vector<SensorTurn> turns;
  EXPECT_EQ(decoder.Decode({}, turns), "must be 1198 bytes (got 0)");
  EXPECT_EQ(RefusalOfPacketWith<std::uint16_t>(0, 0xEEFF), "flag must be 65518 (got 61183)");
  EXPECT_EQ(RefusalOfPacketWith<Byte>(2, 40), "lasers must be 64 (got 40)");
  EXPECT_EQ(RefusalOfPacketWith<Byte>(3, 8), "blocks must be 6 (got 8)");
  EXPECT_EQ(RefusalOfPacketWith<Byte>(5, 0), "distance unit must be > 0 (got 0)");
  EXPECT_EQ(RefusalOfPacketWith<std::uint32_t>(kPandar64TimePlace, 1'000'000),
            "microseconds of the second must be < 1000000 (got 1000000)");
  EXPECT_EQ(RefusalOfPacketWith<Byte>(kMode, 0x3A),
            "return mode must be 51, 55, 56, 57, 59 or 60 (got 58)");
  EXPECT_EQ(
      RefusalOfPacketWith<std::uint16_t>(kPandar64HeaderSize + 2 * kPandar64BlockSize, 36'000),
      "block 2: azimuth must be <= 35999 (got 36000)");
  EXPECT_EQ(RefusalOfPacketWith<std::uint16_t>(kPandar64HeaderSize + 3 * kPandar64BlockSize, 77),
            "block 3: azimuth must be that of its pair (got 77)");
}

std::filesystem::path HesaiCapture(const char* name) {
  return std::filesystem::path(RAILCAST_SHARED_DATA_DIR "/lidar_packets_nebula") / name;
}

using Cell = std::tuple<long, long, long>;  // In cells of 1 cm.

Cell CellOf(float x, float y, float z) {
  return {std::lround(100.0F * x), std::lround(100.0F * y), std::lround(100.0F * z)};
}

/// Returns the distance from a point of the other decoder (x right, y forward) to the nearest of
/// ours in the surrounding cells; 1 m if there is none.
double NearestOf(const std::multimap<Cell, TurnPoint>& cells, const pcl::PointXYZ& point) {
  double nearest_m = 1.0;
  const auto [x, y, z] = CellOf(point.y, -point.x, point.z);
  for (long i = 0; i < 27; ++i) {
    const auto [begin, end] = cells.equal_range({x + i % 3 - 1, y + i / 3 % 3 - 1, z + i / 9 - 1});
    for (auto cell = begin; cell != end; ++cell) {
      const TurnPoint& ours = cell->second;
      const Vector3 apart_m(static_cast<double>(ours.x - point.y),
                            static_cast<double>(ours.y + point.x),
                            static_cast<double>(ours.z - point.z));
      nearest_m = std::min(nearest_m, apart_m.norm());
    }
  }
  return nearest_m;
}

TEST(Pandar64Decoder, GivesTheReferenceCloud) {
  const auto file = HesaiCapture("pandar64.pcap");
  if (!exists(file)) GTEST_SKIP() << file << " is not there";
  PcapReader reader(file);
  Pandar64Decoder decoder;
  std::vector<SensorTurn> turns;
  while (const auto datagram = reader.Next()) {
    ASSERT_EQ(decoder.Decode(datagram->payload, turns), std::nullopt);
  }
  // The capture holds four whole turns. The published cloud is the third, except for points that a
  // laser saw beyond azimuth 0 on either side, before or after its block had passed it.
  ASSERT_EQ(turns.size(), 4U);
  pcl::PointCloud<pcl::PointXYZ> theirs;
  ASSERT_EQ(pcl::io::loadPCDFile(HesaiCapture("pandar64_decoded.pcd").string(), theirs), 0);
  ASSERT_EQ(theirs.size(), 93'591U);
  std::multimap<Cell, TurnPoint> cells;
  for (std::size_t i = 1; i < 4; ++i) {
    for (const TurnPoint& point : turns[i].points) {
      const bool is_near_seam =
          std::abs(std::remainder(DegFromRad(static_cast<double>(point.azimuth_rad)), 360.0)) < 6.0;
      if (i == 2 || is_near_seam) cells.emplace(CellOf(point.x, point.y, point.z), point);
    }
  }
  std::vector<double> distances_m;
  for (const pcl::PointXYZ& point : theirs) distances_m.push_back(NearestOf(cells, point));
  std::ranges::sort(distances_m);
  // The float32 rounding of both clouds at up to 200 m.
  constexpr double kSame_m = 5e-5;
  const auto num_same = std::ranges::upper_bound(distances_m, kSame_m) - distances_m.begin();
  const double share = static_cast<double>(num_same) / static_cast<double>(theirs.size());
  const double median_m = distances_m[distances_m.size() / 2];
  RecordProperty("share", std::to_string(share));
  RecordProperty("median_um", std::to_string(1e6 * median_m));
  EXPECT_EQ(share, 1.0) << num_same << " the same, the farthest at " << distances_m.back() << " m";
  EXPECT_LT(median_m, 1e-6);
}

}  // namespace
}  // namespace railcast
