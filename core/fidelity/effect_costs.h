#pragma once

#include "core/detect/detect_spec.h"

namespace railcast {

/// What one effect costs, so that the choice of effects depends on no clock.
struct EffectCost {
  bool EffectSet::*effect;
  double instructions;  ///< Per firing, on top of the others.
};

/// Instructions per firing of Simulator::Scan without any effect.
inline constexpr double kInstructionsOfGeometry = 3413.0;

/// The effects whose need is measured.
///
/// Callgrind's counts of Simulator::Scan on frame 0 of scenarios/open_line.json in heavy rain, rung
/// `footprint`, less those with the effect switched off (scripts/measure_effect_costs.sh); 10 where
/// that is less, since switching an effect off also changes what the others have to do. Counts
/// differ from scene to scene, but hardly in their order, and the order is what decides.
inline constexpr EffectCost kEffectCosts[] = {
    {&EffectSet::surface_response, 246.0}, {&EffectSet::surface_condition, 10.0},
    {&EffectSet::extinction, 30.0},        {&EffectSet::pulse_stretch, 10.0},
    {&EffectSet::detection, 35.0},         {&EffectSet::detection_probability, 55.0},
    {&EffectSet::footprint, 24379.0},      {&EffectSet::thin_conductors, 125.0},
};

/// The estimate for a set.
[[nodiscard]] constexpr double InstructionsOf(const EffectSet& effects) {
  double sum = kInstructionsOfGeometry;
  for (const EffectCost& cost : kEffectCosts) {
    if (effects.*cost.effect) sum += cost.instructions;
  }
  return sum;
}

}  // namespace railcast
