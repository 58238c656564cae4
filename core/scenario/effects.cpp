#include "core/scenario/effects.h"

#include <initializer_list>

#include "core/base/error.h"
#include "core/scenario/effect_names.h"
#include "core/scenario/json_rules.h"
#include "core/scenario/scenario.h"

namespace railcast {
namespace {

constexpr EffectSet kPlausibility{
    .threshold = true, .rain = true, .snow = true, .noise = true, .sensor_dropout = true};

constexpr EffectSet kSurface{.sensor_dropout = true,
                             .surface_response = true,
                             .surface_condition = true,
                             .extinction = true,
                             .pulse_stretch = true,
                             .detection = true,
                             .detection_probability = true,
                             .clutter = true,
                             .fog_echo = true,
                             .sunlight = true,
                             .range_noise = true,
                             .channel_bias = true,
                             .pointing_jitter = true};

constexpr EffectSet With(EffectSet effects, std::initializer_list<bool EffectSet::*> more) {
  for (bool EffectSet::*effect : more) effects.*effect = true;
  return effects;
}

struct Rung {
  const char* name;
  EffectSet effects;
};

constexpr Rung kRungs[] = {
    {"geometry", {}},
    {"plausibility", kPlausibility},
    {"surface", kSurface},
    {"footprint", With(kSurface, {&EffectSet::footprint, &EffectSet::thin_conductors})},
    {"reference",
     With(kSurface,
          {&EffectSet::footprint, &EffectSet::dense_footprint, &EffectSet::sampled_waveform})},
};

// The first effect that is on in both sets.
const char* FirstOfBoth(const EffectSet& effects, const EffectSet& group) {
  for (const auto& [name, effect] : kEffects) {
    if (effects.*effect && group.*effect) return name;
  }
  return nullptr;
}

EffectSet PublishedEffects() {
  EffectSet published = kPlausibility;
  published.sensor_dropout = false;
  return published;
}

EffectSet PhysicalEffects() {
  EffectSet physical;
  for (const auto& [name, effect] : kEffects) physical.*effect = !(kPlausibility.*effect);
  return physical;
}

}  // namespace

std::vector<std::string> RungNames() {
  std::vector<std::string> names;
  for (const Rung& rung : kRungs) names.emplace_back(rung.name);
  return names;
}

std::vector<std::string> FidelityNames() {
  std::vector<std::string> names = RungNames();
  names.emplace_back(kAutoFidelity);
  return names;
}

EffectSet EffectsOfRung(std::string_view rung) {
  for (const Rung& known : kRungs) {
    if (rung == known.name) return known.effects;
  }
  throw InputError("fidelity: must be " + InWords(RungNames()) + " (got \"" + std::string(rung) +
                   "\")");
}

std::optional<std::string> ConflictIn(const EffectSet& effects) {
  const char* const published = FirstOfBoth(effects, PublishedEffects());
  const char* const physical = FirstOfBoth(effects, PhysicalEffects());
  const auto quoted = [](const char* name) { return '"' + std::string(name) + '"'; };
  if (published != nullptr && physical != nullptr) {
    return quoted(published) + " of the published model and " + quoted(physical) +
           " of physics must not both be on";
  }
  if (effects.dense_footprint && !effects.footprint) {
    return "\"dense_footprint\" must not be on without \"footprint\"";
  }
  if (effects.dense_footprint && effects.thin_conductors) {
    return "\"dense_footprint\" and \"thin_conductors\" must not both be on";
  }
  return std::nullopt;
}

EffectSet EffectsOf(const ScenarioSpec& spec) {
  const EffectSet effects = SwitchedEffects(spec);
  if (const auto conflict = ConflictIn(effects)) throw InputError("/effects: " + *conflict);
  return effects;
}

}  // namespace railcast
