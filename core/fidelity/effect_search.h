#pragma once

#include <functional>
#include <vector>

#include "core/detect/detect_spec.h"
#include "core/fidelity/deviation.h"
#include "core/fidelity/effect_costs.h"

namespace railcast {

/// What a search among effects came to.
struct EffectSearchResult {
  EffectSet effects;               ///< The cheapest that are within the limits.
  Deviation deviation;             ///< Theirs.
  Deviation full_deviation;        ///< Of all.
  std::vector<Deviation> without;  ///< Of all but one, in the order of the candidates.
};

/// Finds the cheapest set within a tolerance, measuring few of all that there are.
///
/// Each candidate is left out by itself. Of the sets whose changes, added up, stay within the
/// limits, the cheapest is measured as a whole, since effects work on each other. While it is
/// beyond a limit, that effect is put back which brings it nearest. The limits are 0.8 of the
/// tolerance, for frames differ. Where all effects together are beyond that (the reference has many
/// more rays) a set may exceed them by 0.02 of the tolerance.
/// @param candidates At most 16; all of them on in `full`.
/// @param measure The deviation of a set; called one at a time.
[[nodiscard]] EffectSearchResult FindCheapestEffects(
    const EffectSet& full,
    const std::vector<EffectCost>& candidates,
    const ToleranceSpec& tolerance,
    const std::function<Deviation(const EffectSet&)>& measure);

}  // namespace railcast
