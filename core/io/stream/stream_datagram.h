#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>

#include "core/io/image/png.h"
#include "railcast/io/stream.h"

namespace railcast {

/// A datagram of an image whose every statement has been checked. Its spans refer to the datagram's
/// own bytes.
struct ImageDatagram {
  std::uint32_t run{};
  std::uint32_t frame{};
  std::int64_t stamp_ns{};
  std::uint16_t packet{};
  std::uint16_t num_packets{};
  std::uint32_t bytes_each{};  ///< Bytes in every datagram of the image but the last.
  ImageSize size;
  std::span<const char> header;
  std::span<const char> piece;  ///< Of the JPEG file.
};

/// Checks all that can be checked of a single datagram of the protocol for images (docs/stream.md):
/// empty if it must be refused.
[[nodiscard]] std::optional<ImageDatagram> CheckImageDatagram(std::span<const char> bytes);

/// Whether two headers describe the same image: they may differ only in the datagram's number and
/// in the place of its piece.
[[nodiscard]] bool DescribeOneImage(std::span<const char> header_a, std::span<const char> header_b);

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
