#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>

#include "railcast/io/stream.h"

namespace railcast {

/// A datagram whose every statement has been checked. Its spans refer to the datagram's own bytes.
struct StreamDatagram {
  std::uint32_t run{};
  std::uint16_t sensor{};
  std::uint32_t frame{};
  std::uint16_t packet{};
  std::uint16_t num_packets{};
  std::uint16_t points_each{};  ///< Points in every datagram of the frame but the last.
  std::uint16_t num_points{};   ///< Points in this datagram.
  std::span<const char> header;
  std::span<const char> points;
};

/// Checks all that can be checked of a single datagram.
/// @param fault Set if the result is empty.
[[nodiscard]] std::optional<StreamDatagram> CheckStreamDatagram(std::span<const char> bytes,
                                                                StreamFault& fault);

/// Whether two headers describe the same frame: they may differ only in the datagram's number and
/// points.
[[nodiscard]] bool DescribeOneFrame(std::span<const char> header_a, std::span<const char> header_b);

/// @pre `header` comes from a checked datagram.
[[nodiscard]] StreamHeader ReadStreamHeader(std::span<const char> header);

}  // namespace railcast
