#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string_view>

#include "core/io/stream/stream_format.h"

namespace railcast {

/// Why a datagram is refused.
enum class StreamFault : std::uint8_t {
  kSize,       ///< Shorter than a header, longer than 1400 bytes, or not as long as it says.
  kMagic,      ///< Another protocol.
  kVersion,    ///< A version or flags that version 1 does not have.
  kChecksum,   ///< Damaged.
  kFields,     ///< A field list that is none: types, names, sizes.
  kCounts,     ///< Numbers of points and packets that contradict each other.
  kPose,       ///< Not finite, or no rotation.
  kDisagrees,  ///< Says otherwise than the frame's first datagram.
};

inline constexpr std::array<std::string_view, 8> kStreamFaultNames = {
    "size", "magic", "version", "checksum", "fields", "counts", "pose", "disagrees"};

/// A datagram whose every claim has been checked. Its spans are the datagram's own bytes.
struct StreamDatagram {
  std::uint32_t run{};
  std::uint16_t sensor{};
  std::uint32_t frame{};
  std::uint16_t packet{};
  std::uint16_t num_packets{};
  std::uint16_t points_each{};  ///< In every datagram of the frame but the last.
  std::uint16_t num_points{};   ///< In this datagram.
  std::span<const char> header;
  std::span<const char> points;
};

/// Checks all that can be checked of a datagram alone.
/// @param fault Set if the result is empty.
[[nodiscard]] std::optional<StreamDatagram> CheckStreamDatagram(std::span<const char> bytes,
                                                                StreamFault& fault);

/// Whether two headers describe the same frame: they differ in nothing but the datagram's number
/// and points.
[[nodiscard]] bool DescribeOneFrame(std::span<const char> header_a, std::span<const char> header_b);

/// @pre `header` is of a checked datagram.
[[nodiscard]] StreamHeader ReadStreamHeader(std::span<const char> header);

}  // namespace railcast
