#pragma once

#include <cstdint>
#include <string_view>

#include "core/io/image/png_decoder.h"

namespace railcast {

/// Decodes a baseline JPEG file with three colours in one scan, as EncodeJpeg() writes it: red,
/// green and blue of each pixel.
/// @param size The size that the image must have.
/// @throws InputError "rule" if it is damaged, of another kind, or of another size.
/// @pre `size` has at most kMostPixels.
[[nodiscard]] DecodedImage<std::uint8_t> DecodeJpegRgb(std::string_view bytes,
                                                       const ImageSize& size);

}  // namespace railcast
