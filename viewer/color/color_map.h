#pragma once

#include <array>
#include <cstdint>
#include <string_view>

#include "viewer/color/rgb.h"

namespace railcast {

/// Colours for amounts, in even steps as the eye sees them.
///
/// viridis and magma: van der Walt and Smith, matplotlib 1.5 (CC0); cividis, made for eyes that see
/// red and green alike: Nunez, Anderton and Renslow 2018, PLOS ONE 13(7); coolwarm, with two ends
/// about a middle: Moreland 2009, "Diverging Color Maps for Scientific Visualization".
enum class ColorMap : std::uint8_t { kViridis, kCividis, kMagma, kCoolwarm };

inline constexpr std::array<std::string_view, 4> kColorMapNames = {"viridis", "cividis", "magma",
                                                                   "coolwarm"};

/// The colour of a place in [0, 1], straight lines between 17 published colours (at most 11 of 255
/// off those between). The darkest fifth of all but coolwarm is not used: it would sink into the
/// background. Places beyond the ends have the end's colour.
[[nodiscard]] Rgb MapColor(ColorMap map, double place);

/// Of points without a value.
inline constexpr Rgb kNoValueColor = {110, 110, 110};

}  // namespace railcast
