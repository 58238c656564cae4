#include "core/fidelity/effect_search.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/detect/effect_table.h"

namespace railcast {
namespace {

/// A set of candidates: bit i stands for candidate i.
using EffectBits = unsigned;

bool IsIn(EffectBits bits, std::size_t i) {
  return (bits >> i & 1U) != 0;
}

// The growth of a deviation when an effect is left out. By chance the deviation may also shrink;
// that counts as 0, since it does not justify leaving out another effect.
double Growth(const Deviation& without, const Deviation& full, const DeviationQuantity& quantity) {
  const double growth = without.*quantity.value - full.*quantity.value;
  return std::isnan(growth) ? 0.0 : std::max(growth, 0.0);
}

// The limits for the sample frames. They are stricter than the tolerance, so that other frames are
// likely to be within it as well.
ToleranceSpec SearchLimits(ToleranceSpec tolerance, const Deviation& full) {
  constexpr double kMargin = 0.8;
  // Share of the tolerance that may be added where all effects together exceed the margin.
  constexpr double kLittle = 0.02;
  for (const DeviationQuantity& quantity : kDeviationQuantities) {
    double& limit = tolerance.*quantity.limit;
    limit = std::max(kMargin * limit, full.*quantity.value + kLittle * limit);
  }
  return tolerance;
}

// By how much a deviation exceeds the limits: the sum over quantities of excess over limit.
double Excess(const Deviation& deviation, const ToleranceSpec& limits) {
  constexpr double kLeastLimit = 1e-9;  // Avoids a division by a tolerance of 0.
  double excess = 0.0;
  for (const DeviationQuantity& quantity : kDeviationQuantities) {
    const double limit = limits.*quantity.limit;
    excess += std::max(deviation.*quantity.value - limit, 0.0) / std::max(limit, kLeastLimit);
  }
  return excess;
}

bool IsPredictedWithin(const EffectSearchResult& result,
                       EffectBits left_out,
                       const ToleranceSpec& limits) {
  Deviation sum = result.full_deviation;
  for (const DeviationQuantity& quantity : kDeviationQuantities) {
    for (std::size_t i = 0; i < result.without.size(); ++i) {
      if (!IsIn(left_out, i)) continue;
      sum.*quantity.value += Growth(result.without[i], result.full_deviation, quantity);
    }
  }
  return IsWithin(sum, limits);
}

// The candidates that are worth leaving out. An effect that matters and costs next to nothing
// stays: other frames may need it more than the samples do, above all the one for wires, of which a
// frame has few.
EffectBits WorthLeavingOut(const EffectSearchResult& result,
                           const std::vector<EffectCost>& candidates) {
  double all_instructions = 0.0;
  for (const EffectCost& candidate : candidates) all_instructions += candidate.instructions;
  constexpr double kNextToNothing = 0.01;
  EffectBits worth = 0;
  for (std::size_t i = 0; i < candidates.size(); ++i) {
    const bool changes_nothing = std::all_of(
        std::begin(kDeviationQuantities), std::end(kDeviationQuantities),
        [&](const auto& q) { return Growth(result.without[i], result.full_deviation, q) == 0.0; });
    if (changes_nothing || candidates[i].instructions >= kNextToNothing * all_instructions) {
      worth |= 1U << i;
    }
  }
  return worth;
}

// The most expensive set of candidates that may be left out, predicted by adding up the changes
// that each of them causes alone.
EffectBits PredictLeftOut(const EffectSearchResult& result,
                          const std::vector<EffectCost>& candidates,
                          EffectBits worth,
                          const ToleranceSpec& limits) {
  EffectBits best = 0;
  double best_saving = -1.0;
  for (EffectBits bits = 0; bits < 1U << candidates.size(); ++bits) {
    if ((bits & ~worth) != 0) continue;
    double saving = 0.0;
    for (std::size_t i = 0; i < candidates.size(); ++i) {
      if (IsIn(bits, i)) saving += candidates[i].instructions;
    }
    if (saving > best_saving && IsPredictedWithin(result, bits, limits)) {
      best = bits;
      best_saving = saving;
    }
  }
  return best;
}

}  // namespace

double InstructionsOf(const EffectSet& effects) {
  double sum = kInstructionsOfGeometry;
  for (const Effect& effect : EffectTable()) {
    if (effects.*effect.is_on) sum += effect.instructions.value_or(0.0);
  }
  return sum;
}

EffectSearchResult FindCheapestEffects(const EffectSet& full,
                                       const std::vector<EffectCost>& candidates,
                                       const ToleranceSpec& tolerance,
                                       const std::function<Deviation(const EffectSet&)>& measure) {
  const auto remaining = [&](EffectBits left_out) {
    EffectSet effects = full;
    for (std::size_t i = 0; i < candidates.size(); ++i) {
      if (IsIn(left_out, i)) effects.*candidates[i].effect = false;
    }
    return effects;
  };
  EffectSearchResult result;
  result.full_deviation = measure(full);
  for (std::size_t i = 0; i < candidates.size(); ++i) {
    result.without.push_back(measure(remaining(1U << i)));
  }
  const ToleranceSpec limits = SearchLimits(tolerance, result.full_deviation);
  const EffectBits worth = WorthLeavingOut(result, candidates);
  EffectBits left_out = PredictLeftOut(result, candidates, worth, limits);
  result.deviation = measure(remaining(left_out));
  while (left_out != 0 && !IsWithin(result.deviation, limits)) {
    // Bring back the effect that leads nearest to the limits, or the cheaper of two alike.
    double least_excess = std::numeric_limits<double>::infinity();
    double least_cost = 0.0;
    EffectBits nearest = 0;  // All effects, unless a set with finite excess is found.
    Deviation nearest_deviation = result.full_deviation;
    for (std::size_t i = 0; i < candidates.size(); ++i) {
      if (!IsIn(left_out, i)) continue;
      const EffectBits fewer = left_out & ~(1U << i);
      const Deviation deviation = measure(remaining(fewer));
      const double excess = Excess(deviation, limits);
      const double cost = candidates[i].instructions;
      if (excess > least_excess || (excess == least_excess && cost >= least_cost)) continue;
      least_excess = excess;
      least_cost = cost;
      nearest = fewer;
      nearest_deviation = deviation;
    }
    left_out = nearest;
    result.deviation = nearest_deviation;
  }
  result.effects = remaining(left_out);
  return result;
}

Deviation DeviationOf(const FrameDifference& difference) {
  const bool lacks_intensity =
      difference.echoes.num_matched > 0 && std::isnan(difference.intensity.median);
  const auto or_zero = [](double value) { return std::isnan(value) ? 0.0 : value; };
  return {or_zero(difference.range_m.median), 1.0 - difference.reference_echoes.share(),
          1.0 - difference.echoes.share(), 1.0 - difference.thin.share(),
          lacks_intensity ? std::numeric_limits<double>::infinity()
                          : or_zero(difference.intensity.median)};
}

bool IsWithin(const Deviation& deviation, const ToleranceSpec& tolerance) {
  return std::all_of(std::begin(kDeviationQuantities), std::end(kDeviationQuantities),
                     [&](const DeviationQuantity& quantity) {
                       return deviation.*quantity.value <= tolerance.*quantity.limit;
                     });
}

}  // namespace railcast
