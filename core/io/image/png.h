#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

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

/// An image as it was read: a value, or several, a pixel, row by row from the upper left.
template <typename Value>
struct DecodedImage {
  ImageSize size;
  std::vector<Value> values;
};

/// Decodes a PNG file with 8 bits of red, green and blue: three values a pixel.
/// @throws InputError "rule" if it is damaged, of another kind, or larger than kMostPixels.
[[nodiscard]] DecodedImage<std::uint8_t> DecodePngRgb(std::string_view bytes);

/// Decodes a PNG file with 16 bits of grey, as EncodePngGrey16() writes them.
/// @throws InputError as DecodePngRgb() does.
[[nodiscard]] DecodedImage<std::uint16_t> DecodePngGrey16(std::string_view bytes);

}  // namespace railcast
