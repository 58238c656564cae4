#pragma once

#include <array>
#include <cstdint>
#include <string>

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

}  // namespace railcast
