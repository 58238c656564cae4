#pragma once

#include <cstdint>
#include <random>

#include "core/io/net/udp.h"
#include "railcast/error.h"

namespace railcast {

/// Returns a domain in which nobody seems to be on this machine, so that tests that run at the same
/// time do not meet.
inline std::uint32_t FreeDomain() {
  // Higher ones are within the range of ports that the kernel hands out.
  constexpr std::uint32_t kNumDomains = 100;
  constexpr std::uint32_t kPortsEach = 250;
  constexpr std::uint32_t kFirstUnicastPort = 7410;
  constexpr std::uint32_t kLoopback = 0x7F000001;
  std::random_device random;
  while (true) {
    const std::uint32_t domain = 1 + random() % kNumDomains;
    try {
      const auto port = static_cast<std::uint16_t>(kFirstUnicastPort + kPortsEach * domain);
      const UdpReceiver unused({kLoopback, port});
      return domain;
    } catch (const InputError&) {
      // Somebody is there.
    }
  }
}

}  // namespace railcast
