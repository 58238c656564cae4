#pragma once

#include <string>
#include <utility>
#include <vector>

#include "core/detect/detect_spec.h"
#include "core/scenario/effects.h"
#include "core/scenario/scenario_spec.h"

namespace railcast {

/// The effects by their name in a scenario.
inline constexpr std::pair<const char*, bool EffectSet::*> kEffects[] = {
    {"threshold", &EffectSet::threshold},
    {"rain", &EffectSet::rain},
    {"snow", &EffectSet::snow},
    {"noise", &EffectSet::noise},
    {"sensor_dropout", &EffectSet::sensor_dropout},
    {"surface_response", &EffectSet::surface_response},
    {"surface_condition", &EffectSet::surface_condition},
    {"extinction", &EffectSet::extinction},
    {"pulse_stretch", &EffectSet::pulse_stretch},
    {"detection", &EffectSet::detection},
    {"detection_probability", &EffectSet::detection_probability},
    {"clutter", &EffectSet::clutter},
    {"fog_echo", &EffectSet::fog_echo},
    {"sunlight", &EffectSet::sunlight},
    {"range_noise", &EffectSet::range_noise},
    {"channel_bias", &EffectSet::channel_bias},
    {"pointing_jitter", &EffectSet::pointing_jitter},
    {"footprint", &EffectSet::footprint},
    {"thin_conductors", &EffectSet::thin_conductors},
    {"dense_footprint", &EffectSet::dense_footprint},
    {"sampled_waveform", &EffectSet::sampled_waveform},
};

[[nodiscard]] inline std::vector<std::string> EffectNames() {
  std::vector<std::string> names;
  for (const auto& [name, member] : kEffects) names.emplace_back(name);
  return names;
}

/// The effects of a scenario's rung with its switches applied, whether they go together or not. Of
/// `auto` they are those that are chosen from.
[[nodiscard]] inline EffectSet SwitchedEffects(const ScenarioSpec& spec) {
  EffectSet effects = EffectsOfRung(spec.fidelity == kAutoFidelity ? "footprint" : spec.fidelity);
  for (const auto& [name, effect] : kEffects) {
    const auto it = spec.effects.find(name);
    if (it != spec.effects.end()) effects.*effect = it->second;
  }
  return effects;
}

}  // namespace railcast
