// XT32, whose azimuths do not account for the times of the firings, and QT128, of which a cycle
// takes two loops.
#include <gtest/gtest.h>

#include "core/base/units.h"
#include "core/extras/packets/spinning/spinning_decoder.h"
#include "tests/core/extras/packets/hesai/made_packet.h"

namespace railcast {
namespace {

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
  ASSERT_EQ(decoder.Decode(PacketOf(Xt32Model(), 31, kMadeStrongest), turns), std::nullopt);
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
    ASSERT_EQ(decoder.Decode(PacketOf(Xt32Model(), 31, mode), turns), std::nullopt);
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
  EXPECT_EQ(decoder.Decode(packet, turns), "protocol must be 6.1 (got 6.2)");
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
    EXPECT_EQ(decoder.Decode(packet, turns), std::nullopt);
  }
  EXPECT_TRUE(turns.empty());
  return decoder.TakeUnfinished();
}

TEST(Qt128Decoder, RefusesAPacketWithAWrongChecksum) {
  const std::vector<char> packet = MadePacket(Qt128Model());
  SpinningDecoder decoder(Qt128Model());
  std::vector<SensorTurn> turns;
  EXPECT_EQ(decoder.Decode(packet, turns), std::nullopt);
  // A byte that no checksum covers, and one that each of the three does, or is one.
  for (const std::size_t place : {1044U, 12U, 1039U, 1040U, 1045U, 1060U, 1061U, 1090U, 1094U}) {
    std::vector<char> damaged = packet;
    damaged[place] ^= 1;
    EXPECT_EQ(decoder.Decode(damaged, turns).value_or(""), place == 1044 ? "" : kWrongChecksum)
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
