#pragma once

#include <array>
#include <cstdint>
#include <string_view>

#include "viewer/color/palette.h"

namespace railcast {

/// Perceptually uniform colour maps for quantities.
///
/// viridis and magma are by van der Walt and Smith, matplotlib 1.5 (CC0); cividis, designed for
/// red-green colour vision deficiency: Nunez, Anderton and Renslow 2018, PLOS ONE 13(7); coolwarm,
/// a diverging map with a neutral middle: Moreland 2009, "Diverging Color Maps for Scientific
/// Visualization".
enum class ColorMap : std::uint8_t { kViridis, kCividis, kMagma, kCoolwarm };

inline constexpr std::array<std::string_view, 4> kColorMapNames = {"viridis", "cividis", "magma",
                                                                   "coolwarm"};

/// Returns the colour of a place in [0, 1], interpolated linearly between 17 anchors of the
/// published map; between the anchors it is at most 11 of 255 off the published colours. The
/// darkest fifth of every map but coolwarm is not used, because it would be hard to see on a dark
/// background. Places beyond the ends take the colour of the end.
[[nodiscard]] Rgb MapColor(ColorMap map, double place);

/// Colour of points without a value.
inline constexpr Rgb kNoValueColor = {110, 110, 110};

}  // namespace railcast
