#include "core/extras/packets/spinning/spinning_decoder.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "core/base/units.h"
#include "core/io/field_layout.h"
#include "tests/core/extras/packets/hesai/made_packet.h"
#include "tests/support/sensor_file.h"

namespace railcast {
namespace {

std::size_t AzimuthPlace(std::size_t block) {
  return DistancePlace(Pandar64Model(), block, 0) - sizeof(std::uint16_t);
}

SensorTurn Decoded(const std::vector<char>& packet, const SpinningModel& model = Pandar64Model()) {
  SpinningDecoder decoder(model);
  std::vector<SensorTurn> turns;
  EXPECT_EQ(decoder.Decode(packet, turns), std::nullopt);
  EXPECT_TRUE(turns.empty());
  return decoder.TakeUnfinished();
}

TEST(HesaiModel, HasTheChannelsOfTheSensorsFile) {
  for (const SpinningModel& model : HesaiModels()) {
    std::string name(model.protocol);
    std::ranges::replace(name, '-', '_');
    const ScanSpec sensor = ReadSensor(name);
    EXPECT_EQ(model.channels, std::get<SpinningSpec>(sensor.pattern).channels) << name;
  }
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
  const std::int64_t packet_ns = (kSimulationEpoch_s + 86'403) * 1'000'000'000 + 500'000'000;
  EXPECT_EQ(turn.stamp_ns, packet_ns - 42'580 - 277'800 - 54'668);
  EXPECT_EQ(turn.column_time_ns[5], 277'800);  // The time of five cycles.
  EXPECT_EQ(turn.stamp_ns + turn.points[5].time_ns, packet_ns - 42'580 - 23'180);
}

TEST(Pandar64Decoder, TakesTwoBlocksForOneCycleInDualMode) {
  std::vector<char> packet = MadePacket(Pandar64Model(), kMadeDual);
  // Only the returns of the second pair of blocks differ.
  StoreAt<std::uint16_t>(packet.data() + DistancePlace(Pandar64Model(), 3, 0), 200);
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
  SpinningDecoder decoder(Pandar64Model());
  std::vector<SensorTurn> turns;
  for (int i = 0; i < 3; ++i) EXPECT_EQ(decoder.Decode(MadePacket(), turns), std::nullopt);
  EXPECT_EQ(turns.size(), 2U);
  EXPECT_EQ(turns.at(1).num_columns(), 6U);
}

TEST(Pandar64Decoder, CutsTheTurnOfARotorThatStandsStill) {
  std::vector<char> packet = MadePacket();
  for (std::size_t block = 0; block < 6; ++block) {
    StoreAt<std::uint16_t>(packet.data() + AzimuthPlace(block), 7);
  }
  SpinningDecoder decoder(Pandar64Model());
  std::vector<SensorTurn> turns;
  for (int i = 0; turns.empty() && i < 10'000; ++i) {
    ASSERT_EQ(decoder.Decode(packet, turns), std::nullopt);
  }
  ASSERT_EQ(turns.size(), 1U);
  EXPECT_EQ(turns[0].num_columns(), std::size_t{1} << 14U);
}

template <typename Number>
std::string RefusalOfPacketWith(std::size_t place, Number number) {
  std::vector<char> packet = MadePacket(Pandar64Model(), kMadeDual);
  StoreAt<Number>(packet.data() + place, number);
  SpinningDecoder decoder(Pandar64Model());
  std::vector<SensorTurn> turns;
  return decoder.Decode(packet, turns).value_or("");
}

TEST(Pandar64Decoder, RefusesWhatIsNoPacketOfIts) {
  using Byte = std::uint8_t;
  SpinningDecoder decoder(Pandar64Model());
  std::vector<SensorTurn> turns;
  EXPECT_EQ(decoder.Decode({}, turns), "must be 1198 bytes (got 0)");
  EXPECT_EQ(RefusalOfPacketWith<std::uint16_t>(0, 0xEEFF), "flag must be 65518 (got 61183)");
  EXPECT_EQ(RefusalOfPacketWith<Byte>(2, 40), "lasers must be 64 (got 40)");
  EXPECT_EQ(RefusalOfPacketWith<Byte>(3, 8), "blocks must be 6 (got 8)");
  EXPECT_EQ(RefusalOfPacketWith<Byte>(5, 0), "distance unit must be > 0 (got 0)");
  EXPECT_EQ(RefusalOfPacketWith<std::uint32_t>(Pandar64Model().time_place, 1'000'000),
            "microseconds of the second must be < 1000000 (got 1000000)");
  EXPECT_EQ(RefusalOfPacketWith<Byte>(Pandar64Model().mode_place, 0x3A),
            "return mode must be 51, 55, 56, 57, 59 or 60 (got 58)");
  EXPECT_EQ(RefusalOfPacketWith<std::uint16_t>(AzimuthPlace(2), 36'000),
            "block 2: azimuth must be <= 35999 (got 36000)");
  EXPECT_EQ(RefusalOfPacketWith<std::uint16_t>(AzimuthPlace(3), 77),
            "block 3: azimuth must be that of its pair (got 77)");
}

}  // namespace
}  // namespace railcast
