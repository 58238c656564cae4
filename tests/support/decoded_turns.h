#pragma once

#include <gtest/gtest.h>

#include <optional>
#include <vector>

#include "core/extras/packets/spinning/sensor_turn.h"
#include "tests/support/decode_packet.h"

namespace railcast {

/// Returns the turns that a decoder makes of these packets, all of which it takes. The last one may
/// be unfinished.
template <typename Decoder, typename Packets>
[[nodiscard]] std::vector<SensorTurn> TurnsOfPackets(Decoder& decoder, const Packets& packets) {
  std::vector<SensorTurn> turns;
  for (const auto& packet : packets) EXPECT_EQ(DecodePacket(decoder, packet, turns), std::nullopt);
  turns.push_back(decoder.TakeUnfinished());
  return turns;
}

}  // namespace railcast
