#pragma once

#include <cstdint>
#include <optional>
#include <span>

#include "core/io/image/png.h"

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

}  // namespace railcast
