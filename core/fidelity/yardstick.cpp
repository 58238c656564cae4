#include "core/fidelity/yardstick.h"

#include "core/scenario/effects.h"

namespace railcast {

EffectSet YardstickEffects() {
  return WithoutRangeErrors(EffectsOfRung("reference"));
}

EffectSet WithoutRangeErrors(EffectSet effects) {
  effects.range_noise = false;
  effects.channel_bias = false;
  effects.noise = false;
  return effects;
}

}  // namespace railcast
