#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>

#include "core/io/stream/stream_layout.h"
#include "railcast/io/stream.h"

namespace railcast {

/// A datagram of an image whose every statement has been checked. Its span refers to the datagram's
/// own bytes.
struct ImageDatagram {
  ImageHead head;
  std::uint32_t bytes_each{};   ///< Bytes in every datagram of the image but the last.
  std::span<const char> piece;  ///< A piece of the JPEG file.
};

/// Checks all that can be checked of a single datagram of the protocol for images (docs/stream.md):
/// empty if it must be refused.
[[nodiscard]] std::optional<ImageDatagram> CheckImageDatagram(std::span<const char> bytes);

/// A datagram whose every statement has been checked. Its spans refer to the datagram's own bytes.
struct StreamDatagram {
  PointsHead head;
  std::uint16_t points_each{};   ///< Points in every datagram of the frame but the last.
  std::span<const char> header;  ///< With the list of fields.
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
