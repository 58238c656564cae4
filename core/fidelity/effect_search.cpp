#include "core/fidelity/effect_search.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace railcast {
namespace {

/// Candidates by their number's bit.
using EffectBits = unsigned;

bool IsIn(EffectBits bits, std::size_t i) {
  return (bits >> i & 1U) != 0;
}

// What leaving an effect out adds: it may also take some away by chance, which is no reason to
// leave out another.
double Growth(const Deviation& without, const Deviation& full, const DeviationQuantity& quantity) {
  const double growth = without.*quantity.value - full.*quantity.value;
  return std::isnan(growth) ? 0.0 : std::max(growth, 0.0);
}

// What a set must keep to on the sample frames, so that others are within the tolerance, too.
ToleranceSpec SearchLimits(ToleranceSpec tolerance, const Deviation& full) {
  constexpr double kMargin = 0.8;
  constexpr double kLittle = 0.02;  // Of a limit that all effects together hardly reach.
  for (const DeviationQuantity& quantity : kDeviationQuantities) {
    double& limit = tolerance.*quantity.limit;
    limit = std::max(kMargin * limit, full.*quantity.value + kLittle * limit);
  }
  return tolerance;
}

// How far a deviation is beyond the limits, in limits.
double Excess(const Deviation& deviation, const ToleranceSpec& limits) {
  constexpr double kLeastLimit = 1e-9;  // Of a tolerance of 0.
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

// The dearest candidates that may be left out together by their single changes.
EffectBits PredictLeftOut(const EffectSearchResult& result,
                          const std::vector<EffectCost>& candidates,
                          const ToleranceSpec& limits) {
  EffectBits best = 0;
  double best_saving = -1.0;
  for (EffectBits bits = 0; bits < 1U << candidates.size(); ++bits) {
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
  EffectBits left_out = PredictLeftOut(result, candidates, limits);
  result.deviation = measure(remaining(left_out));
  while (left_out != 0 && !IsWithin(result.deviation, limits)) {
    double least_excess = std::numeric_limits<double>::infinity();
    EffectBits nearest = 0;  // All effects, unless another set is nearer.
    Deviation nearest_deviation = result.full_deviation;
    for (std::size_t i = 0; i < candidates.size(); ++i) {
      if (!IsIn(left_out, i)) continue;
      const EffectBits fewer = left_out & ~(1U << i);
      const Deviation deviation = measure(remaining(fewer));
      if (Excess(deviation, limits) >= least_excess) continue;
      least_excess = Excess(deviation, limits);
      nearest = fewer;
      nearest_deviation = deviation;
    }
    left_out = nearest;
    result.deviation = nearest_deviation;
  }
  result.effects = remaining(left_out);
  return result;
}

}  // namespace railcast
