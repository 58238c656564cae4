#pragma once

#include <cstddef>
#include <cstdint>

namespace railcast {

inline constexpr std::size_t kEthernetSize = 14;
inline constexpr std::size_t kIpv4HeaderSize = 20;  ///< Without options.
inline constexpr std::size_t kIpv6HeaderSize = 40;  ///< Without extension headers.
inline constexpr std::size_t kUdpHeaderSize = 8;

/// Place of the checksum in UDP's header, in network byte order.
inline constexpr std::size_t kUdpChecksumPlace = 6;

inline constexpr std::uint8_t kUdpProtocol = 17;  ///< In the headers of IPv4 and IPv6.

}  // namespace railcast
