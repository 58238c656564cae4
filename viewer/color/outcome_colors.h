#pragma once

#include <string>

#include "core/frame/outcome.h"
#include "viewer/color/rgb.h"

namespace railcast {

/// Of firings whose recording has no outcomes.
inline constexpr Rgb kUnknownOutcomeRgb{170, 170, 170};

/// What became of a firing: Okabe and Ito's seven colours and, for what is no loss in the scene
/// (the vehicle itself, the sensor's own, slots that are not used), greys of different lightness.
[[nodiscard]] Rgb OutcomeRgb(Outcome outcome);

/// For legends: "below threshold".
[[nodiscard]] std::string OutcomeTitle(Outcome outcome);

}  // namespace railcast
