#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "core/extras/ros/bag/bag.h"

namespace railcast {

/// A datagram of a sensor in a message.
struct MessagePacket {
  std::vector<char> payload;
  std::int64_t time_ns{};  ///< When it was received.
  std::size_t place{};     ///< Place of the payload in the message's data.
};

/// Returns the datagrams in a message, in their order.
/// @throws InputError "rule (got value)" if the message is damaged.
using PacketsOfMessage = std::vector<MessagePacket> (*)(const bag::BagMessage& message);

/// How the datagrams are taken from messages of a type; null if such messages hold none.
[[nodiscard]] PacketsOfMessage FindPacketsOf(const std::string& type);

}  // namespace railcast
