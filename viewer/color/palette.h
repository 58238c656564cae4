#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <string_view>

#include "railcast/frame.h"

namespace railcast {

using Rgb = std::array<std::uint8_t, 3>;

// Colours that can be told apart with any kind of colour vision (M. Okabe, K. Ito: Color Universal
// Design, 2008), without black, which cannot be seen on dark backgrounds.
inline constexpr Rgb kOrange{230, 159, 0};
inline constexpr Rgb kSkyBlue{86, 180, 233};
inline constexpr Rgb kBluishGreen{0, 158, 115};
inline constexpr Rgb kYellow{240, 228, 66};
inline constexpr Rgb kBlue{0, 114, 178};
inline constexpr Rgb kVermillion{213, 94, 0};
inline constexpr Rgb kReddishPurple{204, 121, 167};

/// Colour of firings whose recording has no outcomes.
inline constexpr Rgb kUnknownOutcomeRgb{170, 170, 170};

/// Returns the colour of an outcome: one of Okabe and Ito's seven colours, or a grey for what is no
/// loss in the scene (hits on the ego vehicle, dropouts of the sensor, unused slots).
[[nodiscard]] Rgb OutcomeRgb(Outcome outcome);

/// Returns an outcome's name for legends: "below threshold".
[[nodiscard]] std::string OutcomeTitle(Outcome outcome);

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
