#pragma once

#include "core/detect/detect_spec.h"

namespace railcast {

/// What all others are compared with: the rung `reference` with the weather's and the sensor's own
/// effects on.
[[nodiscard]] EffectSet YardstickEffects();

/// The effects as they are compared: without what changes ranges at random after detection
/// (`range_noise`, `channel_bias` and the published `noise`), so that what is left is the model's.
/// All other draws are the same for the same seed.
[[nodiscard]] EffectSet WithoutRangeErrors(EffectSet effects);

}  // namespace railcast
