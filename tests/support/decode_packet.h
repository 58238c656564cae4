#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "core/extras/packets/spinning/sensor_turn.h"

namespace railcast {

/// Gives a packet to a decoder and appends the turns that it completes.
/// @returns Why the decoder refuses the packet, of which it then uses nothing.
template <typename Decoder>
[[nodiscard]] std::optional<std::string> DecodePacket(Decoder& decoder,
                                                      std::span<const char> packet,
                                                      std::vector<SensorTurn>& turns) {
  auto refusal = decoder.Refuse(packet);
  if (!refusal) decoder.TakePacket(packet, turns);
  return refusal;
}

}  // namespace railcast
