#include "core/extras/packets/spinning/spinning_decoder.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "core/base/units.h"
#include "core/io/field_layout.h"
#include "tests/core/extras/packets/hesai/made_packet.h"
#include "tests/support/decode_packet.h"
#include "tests/support/sensor_file.h"

namespace railcast {
namespace {

std::size_t AzimuthPlace(std::size_t block) {
  return DistancePlace(Pandar64Model(), block, 0) - sizeof(std::uint16_t);
}

SensorTurn Decoded(const std::vector<char>& packet, const SpinningModel& model = Pandar64Model()) {
  SpinningDecoder decoder(model);
  std::vector<SensorTurn> turns;
  EXPECT_EQ(DecodePacket(decoder, packet, turns), std::nullopt);
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
  for (int i = 0; i < 3; ++i) EXPECT_EQ(DecodePacket(decoder, MadePacket(), turns), std::nullopt);
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
    ASSERT_EQ(DecodePacket(decoder, packet, turns), std::nullopt);
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
  return DecodePacket(decoder, packet, turns).value_or("");
}

TEST(Pandar64Decoder, RefusesWhatIsNoPacketOfIts) {
  using Byte = std::uint8_t;
  SpinningDecoder decoder(Pandar64Model());
  std::vector<SensorTurn> turns;
  EXPECT_EQ(DecodePacket(decoder, {}, turns), "must be 1198 bytes (got 0)");
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

// XT32, whose azimuths do not account for the times of the firings, and QT128, of which a cycle
// takes two loops.

/// A packet of which one laser measures 1 m in all blocks, and no other anything.
std::vector<char> PacketOf(const SpinningModel& model, std::size_t laser, std::uint8_t mode) {
  std::vector<char> packet = MadePacket(model, mode);
  for (std::size_t block = 0; block < model.blocks; ++block) {
    StoreAt<std::uint16_t>(packet.data() + DistancePlace(model, block, 0), 0);
    StoreAt<std::uint16_t>(packet.data() + DistancePlace(model, block, laser), 250);
  }
  return packet;
}

// Laser 31 fires 6 + 31 x 1.512 us after the command to fire, in which the rotor turns by 0.190
// deg.
TEST(Xt32Decoder, AddsTheRotorsTurnUntilTheLaserFires) {
  SpinningDecoder decoder(Xt32Model());
  std::vector<SensorTurn> turns;
  ASSERT_EQ(DecodePacket(decoder, PacketOf(Xt32Model(), 31, kMadeStrongest), turns), std::nullopt);
  const SensorTurn turn = decoder.TakeUnfinished();
  ASSERT_EQ(turn.points.size(), 8U);
  const TurnPoint& point = turn.points[2];
  EXPECT_EQ(point.ring, 0U);
  EXPECT_EQ(point.laser, 31U);
  EXPECT_FLOAT_EQ(point.range_m, 1.0F);
  const double turned_deg = 0.0036 * (6.0 + 31 * 1.512);
  EXPECT_NEAR(turned_deg, 0.190, 5e-4);
  EXPECT_NEAR(point.azimuth_rad, RadFromDeg(1.4 - 0.129679 + turned_deg), 1e-8);
}

// By the manual, the stamp is that of the command to fire the last block.
TEST(Xt32Decoder, CountsTimeFromTheCommandToFireTheLastBlock) {
  for (const auto& [mode, cycles] :
       {std::pair{kMadeStrongest, std::int64_t{8}}, std::pair{kMadeDual, std::int64_t{4}}}) {
    SpinningDecoder decoder(Xt32Model());
    std::vector<SensorTurn> turns;
    ASSERT_EQ(DecodePacket(decoder, PacketOf(Xt32Model(), 31, mode), turns), std::nullopt);
    const SensorTurn turn = decoder.TakeUnfinished();
    ASSERT_EQ(turn.num_columns(), static_cast<std::size_t>(cycles));
    const std::int64_t packet_ns = (kSimulationEpoch_s + 86'403) * 1'000'000'000 + 500'000'000;
    EXPECT_EQ(turn.stamp_ns, packet_ns + 6'000 - 50'000 * (cycles - 1));
    EXPECT_EQ(turn.stamp_ns + turn.points.back().time_ns, packet_ns + 6'000 + 46'872);
  }
}

TEST(Xt32Decoder, RefusesAnotherProtocol) {
  std::vector<char> packet = MadePacket(Xt32Model());
  packet[3] = 2;
  SpinningDecoder decoder(Xt32Model());
  std::vector<SensorTurn> turns;
  EXPECT_EQ(DecodePacket(decoder, packet, turns), "protocol must be 6.1 (got 6.2)");
}

/// A dual packet of a loop, 1 or 2: laser 64 fires in both.
std::vector<char> LoopPacket(std::size_t loop, std::uint16_t azimuth, std::uint32_t time_us) {
  const SpinningModel& model = Qt128Model();
  std::vector<char> packet = PacketOf(model, 64, kMadeDual);
  for (std::size_t block = 0; block < 2; ++block) {
    StoreAt<std::uint16_t>(packet.data() + DistancePlace(model, block, 0) - 2, azimuth);
  }
  packet[model.loop_place] = loop == 1 ? 1 : 0;
  StoreAt<std::uint32_t>(packet.data() + model.time_place, time_us);
  return packet;
}

SensorTurn TurnOf(const std::vector<std::vector<char>>& packets) {
  SpinningDecoder decoder(Qt128Model());
  std::vector<SensorTurn> turns;
  for (std::vector<char> packet : packets) {
    StoreChecksums(Qt128Model(), packet);
    EXPECT_EQ(DecodePacket(decoder, packet, turns), std::nullopt);
  }
  EXPECT_TRUE(turns.empty());
  return decoder.TakeUnfinished();
}

TEST(Qt128Decoder, RefusesAPacketWithAWrongChecksum) {
  const std::vector<char> packet = MadePacket(Qt128Model());
  SpinningDecoder decoder(Qt128Model());
  std::vector<SensorTurn> turns;
  EXPECT_EQ(DecodePacket(decoder, packet, turns), std::nullopt);
  // A byte that no checksum covers, and one that each of the three does, or is one.
  for (const std::size_t place : {1044U, 12U, 1039U, 1040U, 1045U, 1060U, 1061U, 1090U, 1094U}) {
    std::vector<char> damaged = packet;
    damaged[place] ^= 1;
    EXPECT_EQ(DecodePacket(decoder, damaged, turns).value_or(""),
              place == 1044 ? "" : kWrongChecksum)
        << place;
  }
}

// Laser 65 of the manual fires 1.456 us after loop 1 began and 0.6 us after loop 2 did.
TEST(Qt128Decoder, MakesACycleOfTwoLoops) {
  const SensorTurn turn = TurnOf({LoopPacket(1, 80, 1000), LoopPacket(2, 120, 1111)});
  ASSERT_EQ(turn.num_columns(), 1U);
  ASSERT_EQ(turn.points.size(), 2U);  // The second return repeats the first.
  const auto& [first, second] = std::pair{turn.points[0], turn.points[1]};
  EXPECT_NEAR(first.azimuth_rad, RadFromDeg(0.8 + 5.949064148 + 0.0036 * 1.456), 1e-7);
  EXPECT_NEAR(second.azimuth_rad, RadFromDeg(1.2 + 5.949064148 + 0.0036 * 0.6), 1e-7);
  EXPECT_EQ(first.time_ns, 856);
  EXPECT_EQ(second.time_ns, 111'111);
  EXPECT_EQ(second.laser, 64U);
  EXPECT_EQ(second.ring, first.ring + 1U);
  EXPECT_EQ(turn.stamp_ns % 1'000'000'000, 1'000'000 + 9'600);
}

TEST(Qt128Decoder, LeavesOutACycleThatLacksALoop) {
  EXPECT_EQ(TurnOf({LoopPacket(2, 40, 889), LoopPacket(1, 80, 1000), LoopPacket(2, 120, 1111)})
                .num_columns(),
            1U);
  const SensorTurn turn =
      TurnOf({LoopPacket(1, 80, 1000), LoopPacket(1, 160, 1222), LoopPacket(2, 200, 1333)});
  ASSERT_EQ(turn.num_columns(), 1U);
  EXPECT_NEAR(turn.points[0].azimuth_rad, RadFromDeg(1.6 + 5.949064148 + 0.0036 * 1.456), 1e-7);
  // Loop 2 is that of a later cycle.
  EXPECT_EQ(TurnOf({LoopPacket(1, 80, 1000), LoopPacket(2, 200, 1333)}).num_columns(), 0U);
}

// Cycles of a packet for each loop, of which some are missing.
TEST(Qt128Decoder, CountsPacketsThatLackTheRestOfTheirCycle) {
  constexpr std::size_t kNumPackets = 40;
  for (const std::size_t each : {2U, 3U, 4U, 5U, 10U}) {
    for (const bool keeps_few : {true, false}) {
      const auto is_kept = [&](std::size_t packet) {
        return (packet % each == 0) == keeps_few && packet < kNumPackets;
      };
      SpinningDecoder decoder(Qt128Model());
      std::vector<SensorTurn> turns;
      std::size_t num_alone = 0;
      bool is_first = true;
      for (std::size_t i = 0; i < kNumPackets; ++i) {
        if (!is_kept(i)) continue;
        auto packet = LoopPacket(1 + i % 2, static_cast<std::uint16_t>(80 + 40 * i),
                                 static_cast<std::uint32_t>(1000 + 111 * i));
        StoreChecksums(Qt128Model(), packet);
        EXPECT_EQ(DecodePacket(decoder, packet, turns), std::nullopt);
        const bool begins = i % 2 == 1 && is_first;
        if (!is_kept(i ^ 1U) && !begins) ++num_alone;
        is_first = false;
      }
      // What ends with the first loop may go on.
      const bool is_ended = decoder.num_incomplete() == num_alone;
      EXPECT_TRUE(is_ended || decoder.num_incomplete() + 1 == num_alone)
          << each << keeps_few << ": " << decoder.num_incomplete() << " of " << num_alone;
    }
  }
}

TEST(Qt128Decoder, TakesTheBlocksOfASinglePacketForBothLoops) {
  std::vector<char> packet = PacketOf(Qt128Model(), 64, kMadeStrongest);
  packet[Qt128Model().loop_place] = 1;
  const SensorTurn turn = TurnOf({packet});
  ASSERT_EQ(turn.num_columns(), 1U);
  ASSERT_EQ(turn.points.size(), 2U);
  EXPECT_NEAR(turn.points[1].azimuth_rad, RadFromDeg(1.2 + 5.949064148 + 0.0036 * 0.6), 1e-7);
}

// Half of the lasers in each loop, as the manual says; 0 is what the others' returns are filled
// with.
TEST(Qt128Decoder, IgnoresLasersThatDoNotFireInALoop) {
  std::vector<char> packet = LoopPacket(1, 80, 1000);
  StoreAt<std::uint16_t>(packet.data() + DistancePlace(Qt128Model(), 0, 3), 250);
  EXPECT_EQ(TurnOf({packet, LoopPacket(2, 120, 1111)}).points.size(), 2U);
}

}  // namespace
}  // namespace railcast
