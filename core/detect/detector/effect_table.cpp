#include "core/detect/detector/effect_table.h"

#include <algorithm>

#include "core/base/error.h"

namespace railcast {

const std::vector<Effect>& EffectTable() {
  static const std::vector<Effect> table = [] {
    std::vector<Effect> all;
    for (const auto& part :
         {PublishedEffects(), PhysicalEffects(), SensorEffects(), BeamEffects()}) {
      for (const Effect& effect : part) all.push_back(effect);
    }
    // EffectSet consists of bools only, so that its size is the number of effects.
    Check(all.size() == sizeof(EffectSet), "every effect has a row in the table of effects");
    return all;
  }();
  return table;
}

const Effect* FindEffect(std::string_view name) {
  for (const Effect& effect : EffectTable()) {
    if (effect.name == name) return &effect;
  }
  return nullptr;
}

std::vector<std::string> EffectNames() {
  std::vector<std::string> names;
  for (const Effect& effect : EffectTable()) names.emplace_back(effect.name);
  return names;
}

std::vector<std::string> EffectNames(const EffectSet& effects) {
  std::vector<std::string> names;
  for (const Effect& effect : EffectTable()) {
    if (effects.*effect.is_on) names.emplace_back(effect.name);
  }
  return names;
}

const Effect* EffectBetweenBeams(const DetectorSpec& spec) {
  for (const Effect& effect : EffectTable()) {
    if (effect.acts_between_beams && spec.effects.*effect.is_on && effect.has_cause(spec)) {
      return &effect;
    }
  }
  return nullptr;
}

ClutterLabels ClutterLabelsOf(const LabelTable& labels, const DetectorSpec& spec) {
  ClutterLabels ids;
  for (const Effect& effect : EffectTable()) {
    for (const EffectLabel& label : effect.labels) {
      const auto is_needed = label.is_needed != nullptr ? label.is_needed : &effect.has_cause;
      if (spec.effects.*effect.is_on && is_needed(spec)) {
        ids.*label.id = labels.Id(label.name);
      } else if (const Label* const known = labels.Find(label.name)) {
        ids.*label.id = known->id;
      }
    }
  }
  return ids;
}

bool IsInRung(const Effect& effect, Fidelity rung) {
  return std::find(effect.rungs.begin(), effect.rungs.end(), rung) != effect.rungs.end();
}

EffectSet EffectsInRung(Fidelity rung) {
  EffectSet effects;
  for (const Effect& effect : EffectTable()) effects.*effect.is_on = IsInRung(effect, rung);
  return effects;
}

bool IsPhysical(const EffectSet& effects) {
  return std::any_of(EffectTable().begin(), EffectTable().end(), [&](const Effect& effect) {
    return effects.*effect.is_on && !IsInRung(effect, Fidelity::kPlausibility);
  });
}

}  // namespace railcast
