#pragma once

#include <cstdint>
#include <string_view>
#include <vector>

#include "core/io/image/png_encoder.h"

namespace railcast {

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
