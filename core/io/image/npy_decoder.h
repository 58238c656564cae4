#pragma once

#include <string_view>

#include "core/io/image/png.h"

namespace railcast {

/// Decodes a NumPy array of little-endian float32 in rows, as EncodeNpy() writes it.
/// @throws InputError "rule" if it is anything else, or has more than kMostPixels values.
[[nodiscard]] DecodedImage<float> DecodeNpy(std::string_view bytes);

}  // namespace railcast
