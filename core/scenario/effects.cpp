#include "core/base/error.h"
#include "core/scenario/effect_names.h"
#include "core/scenario/scenario.h"

namespace railcast {

EffectSet EffectsOf(const ScenarioSpec& spec) {
  EffectSet effects;
  for (const auto& [name, effect] : kEffects) {
    effects.*effect = spec.fidelity != "geometry";
    const auto it = spec.effects.find(name);
    if (it != spec.effects.end()) effects.*effect = it->second;
  }
  return effects;
}

}  // namespace railcast
