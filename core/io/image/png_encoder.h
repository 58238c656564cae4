#pragma once

#include <cstdint>
#include <span>
#include <string>

namespace railcast {

/// Width and height of an image.
struct ImageSize {
  std::uint32_t width_px{};
  std::uint32_t height_px{};
};

/// Encodes an image as PNG with 8 bits of red, green and blue.
/// @param rgb Three bytes a pixel, row by row from the upper left.
[[nodiscard]] std::string EncodePngRgb(const ImageSize& size, std::span<const std::uint8_t> rgb);

/// Encodes an image as PNG with 16 bits of grey: the values themselves, without a transfer
/// function.
/// @pre No value exceeds 65535.
[[nodiscard]] std::string EncodePngGrey16(const ImageSize& size,
                                          std::span<const std::uint32_t> values);

}  // namespace railcast
