#pragma once

#include <functional>
#include <vector>

#include "core/fidelity/frame_comparison.h"
#include "railcast/effects.h"
#include "railcast/fidelity.h"

namespace railcast {

/// A compared quantity: its members in Deviation and in ToleranceSpec.
struct DeviationQuantity {
  double Deviation::*value;
  double ToleranceSpec::*limit;
};
inline constexpr DeviationQuantity kDeviationQuantities[] = {
    {&Deviation::range_m, &ToleranceSpec::range_m},
    {&Deviation::missed_share, &ToleranceSpec::missed_share},
    {&Deviation::false_share, &ToleranceSpec::false_share},
    {&Deviation::thin_missed_share, &ToleranceSpec::thin_missed_share},
    {&Deviation::intensity, &ToleranceSpec::intensity},
};

[[nodiscard]] Deviation DeviationOf(const FrameDifference& difference);

/// Instructions per firing of Simulator::Scan without any effect (Effect::instructions).
inline constexpr double kInstructionsOfGeometry = 3413.0;

/// Estimated instructions per firing of Simulator::Scan with a set of effects.
[[nodiscard]] double InstructionsOf(const EffectSet& effects);

/// The cost of one effect.
struct EffectCost {
  bool EffectSet::*effect;
  double instructions;  ///< Per firing, on top of the other effects (Effect::instructions).
};

/// The result of a search among effects.
struct EffectSearchResult {
  EffectSet effects;               ///< The cheapest set within the limits.
  Deviation deviation;             ///< The deviation of that set.
  Deviation full_deviation;        ///< The deviation with all effects.
  std::vector<Deviation> without;  ///< With all effects but one, in the order of the candidates.
};

/// Finds the cheapest set of effects within a tolerance while measuring only a few of all sets.
///
/// First, each candidate is left out on its own. Among the sets whose changes, added up, stay
/// within the limits, the cheapest is measured as a whole, since effects influence each other.
/// While it exceeds a limit, the effect that reduces the excess most is put back. The limits are
/// 0.8 of the tolerance, because frames differ. Where all effects together exceed that (the
/// reference has many more rays), a set may exceed their deviation by 0.02 of the tolerance.
/// @param candidates At most 16; all of them are on in `full`.
/// @param measure Returns the deviation of a set; not called concurrently.
[[nodiscard]] EffectSearchResult FindCheapestEffects(
    const EffectSet& full,
    const std::vector<EffectCost>& candidates,
    const ToleranceSpec& tolerance,
    const std::function<Deviation(const EffectSet&)>& measure);

}  // namespace railcast
