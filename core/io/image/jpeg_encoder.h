#pragma once

#include <cstdint>
#include <span>
#include <string>

#include "core/io/image/png_encoder.h"

namespace railcast {

/// Encodes an image as baseline JPEG, colours at half the resolution (4:2:0).
/// @param rgb As for EncodePngRgb().
/// @param quality 1 to 100, as libjpeg counts it.
[[nodiscard]] std::string EncodeJpeg(const ImageSize& size,
                                     std::span<const std::uint8_t> rgb,
                                     int quality);

}  // namespace railcast
