#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <string>
#include <string_view>

namespace railcast {

/// An IPv4 or IPv6 address.
struct IpAddress {
  /// In network order. IPv4 is mapped: ten bytes 0, two 0xFF, four of IPv4 (RFC 4291, 2.5.5.2).
  std::array<std::uint8_t, 16> bytes{};
  /// Index of the network interface of this machine through which a multicast group or a link-local
  /// address is reached; 0 = none is named, routes decide.
  std::uint32_t interface {};

  /// @param ipv4 In the host's byte order: 0x7F000001 is 127.0.0.1.
  constexpr IpAddress(std::uint32_t ipv4 = 0) {
    bytes[10] = bytes[11] = 0xFF;
    for (unsigned i = 0; i < 4; ++i) bytes[15 - i] = static_cast<std::uint8_t>(ipv4 >> 8U * i);
  }

  [[nodiscard]] constexpr bool is_ipv4() const {
    return bytes[10] == 0xFF && bytes[11] == 0xFF &&
           std::all_of(bytes.begin(), bytes.begin() + 10, [](auto byte) { return byte == 0; });
  }
  /// The IPv4 address in the host's byte order.
  /// @pre is_ipv4()
  [[nodiscard]] constexpr std::uint32_t ipv4() const {
    return std::uint32_t{bytes[12]} << 24U | std::uint32_t{bytes[13]} << 16U |
           std::uint32_t{bytes[14]} << 8U | bytes[15];
  }
  /// 127.0.0.0/8 or ::1: this machine.
  [[nodiscard]] bool is_loopback() const;
  /// 224.0.0.0/4 or ff00::/8.
  [[nodiscard]] bool is_multicast() const;

  bool operator==(const IpAddress&) const = default;
};

/// An address and a UDP port, which is in the host's byte order.
struct Endpoint {
  IpAddress address{};
  std::uint16_t port{};

  [[nodiscard]] bool is_loopback() const { return address.is_loopback(); }
  /// 255.255.255.255: all hosts of the local network. IPv6 has multicast groups instead.
  [[nodiscard]] bool is_broadcast() const { return address == IpAddress(0xFFFFFFFF); }
  /// Whether `other` matches this endpoint: same address and same port, where port 0 matches any.
  [[nodiscard]] bool Covers(const Endpoint& other) const {
    return address == other.address && (port == 0 || port == other.port);
  }
  bool operator==(const Endpoint&) const = default;
};

/// Parses "HOST:PORT", "HOST" or ":PORT". HOST is a dotted-decimal IPv4 address, an IPv6 address,
/// which stands in brackets before a port, or a name: its IPv4 address or, if it has none, its IPv6
/// one. Multicast groups may, and link-local addresses must name the network interface by which
/// they are reached: "239.1.1.1%eth0:2368", "[fe80::1%eth0]:2368".
/// @param default_port Used if no port is written.
/// @throws InputError "rule (got text)".
[[nodiscard]] Endpoint ParseEndpoint(std::string_view text, std::uint16_t default_port);

/// Formats an address as "127.0.0.1" or "fe80::1%eth0".
[[nodiscard]] std::string AddressText(const IpAddress& address);

/// Formats an endpoint as "127.0.0.1:2368" or "[fe80::1%eth0]:2368".
[[nodiscard]] std::string EndpointText(const Endpoint& endpoint);

}  // namespace railcast
