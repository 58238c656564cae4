#pragma once

#include "railcast/effects.h"

namespace railcast {

/// The effects with which all others are compared: the rung `reference` with the effects of the
/// weather and of the sensor on.
[[nodiscard]] EffectSet YardstickEffects();

/// The effects without those that add random errors to ranges after detection (`range_noise`,
/// `channel_bias` and the published `noise`), so that comparisons show only differences between the
/// models. All other random draws are the same for the same seed.
[[nodiscard]] EffectSet WithoutRangeErrors(EffectSet effects);

}  // namespace railcast
