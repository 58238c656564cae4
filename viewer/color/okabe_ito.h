#pragma once

#include "viewer/color/rgb.h"

namespace railcast {

// Colours that people of any colour vision tell apart (M. Okabe, K. Ito: Color Universal Design,
// 2008), without the black, which dark backgrounds swallow.
inline constexpr Rgb kOrange{230, 159, 0};
inline constexpr Rgb kSkyBlue{86, 180, 233};
inline constexpr Rgb kBluishGreen{0, 158, 115};
inline constexpr Rgb kYellow{240, 228, 66};
inline constexpr Rgb kBlue{0, 114, 178};
inline constexpr Rgb kVermillion{213, 94, 0};
inline constexpr Rgb kReddishPurple{204, 121, 167};

}  // namespace railcast
