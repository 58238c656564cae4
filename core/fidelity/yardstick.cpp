#include "core/fidelity/yardstick.h"

#include "core/detect/detector/effect_table.h"

namespace railcast {

EffectSet YardstickEffects() {
  return WithoutRangeErrors(EffectsInRung(Fidelity::kReference));
}

EffectSet WithoutRangeErrors(EffectSet effects) {
  for (const Effect& effect : EffectTable()) {
    if (effect.is_range_error) effects.*effect.is_on = false;
  }
  return effects;
}

}  // namespace railcast
