#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <string_view>

#include "core/io/image/png.h"

namespace railcast {

/// Encodes an image as baseline JPEG, colours at half the resolution (4:2:0).
/// @param rgb As for EncodePngRgb().
/// @param quality 1 to 100, as libjpeg counts it.
[[nodiscard]] std::string EncodeJpeg(const ImageSize& size,
                                     std::span<const std::uint8_t> rgb,
                                     int quality);

/// Decodes a baseline JPEG file with three colours in one scan, as EncodeJpeg() writes it: red,
/// green and blue of each pixel.
/// @param size The size that the image must have.
/// @throws InputError "rule" if it is damaged, of another kind, or of another size.
/// @pre `size` has at most kMostPixels.
[[nodiscard]] DecodedImage<std::uint8_t> DecodeJpegRgb(std::string_view bytes,
                                                       const ImageSize& size);

}  // namespace railcast
