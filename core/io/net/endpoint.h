#pragma once

#include <cstdint>
#include <string>
#include <string_view>

namespace railcast {

/// An IPv4 address and a UDP port, both in the host's byte order.
struct Endpoint {
  std::uint32_t address{};
  std::uint16_t port{};

  [[nodiscard]] bool is_loopback() const { return address >> 24U == 127; }
  /// 255.255.255.255: every host of the local network.
  [[nodiscard]] bool is_broadcast() const { return address == 0xFFFFFFFF; }
  /// Whether `other` is this one; where this port is 0, any port of the address.
  [[nodiscard]] bool Covers(const Endpoint& other) const {
    return address == other.address && (port == 0 || port == other.port);
  }
  bool operator==(const Endpoint&) const = default;
};

/// Reads "HOST:PORT", "HOST" or ":PORT"; HOST is an IPv4 address, dotted decimal, or
/// a name that has one.
/// @param default_port Where none is written.
/// @throws InputError "rule (got text)".
[[nodiscard]] Endpoint ParseEndpoint(std::string_view text, std::uint16_t default_port);

/// "127.0.0.1:2368"
[[nodiscard]] std::string EndpointText(const Endpoint& endpoint);

}  // namespace railcast
