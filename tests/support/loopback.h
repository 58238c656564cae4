#pragma once

#include <optional>

#include "core/io/net/udp.h"
#include "railcast/error.h"

namespace railcast {

/// Any port at 127.0.0.1.
inline constexpr Endpoint kAnyLoopbackPort{0x7F000001, 0};

/// Any port at ::1, or nothing on a machine without IPv6 there.
inline std::optional<Endpoint> AnyIpv6LoopbackPort() {
  const Endpoint any{ParseEndpoint("[::1]:1", 1).address, 0};
  try {
    const UdpReceiver unused(any);
    return any;
  } catch (const InputError&) {
    return std::nullopt;
  }
}

}  // namespace railcast
