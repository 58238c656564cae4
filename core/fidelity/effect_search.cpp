#include "core/fidelity/effect_search.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/detect/detector/effect_table.h"
#include "railcast/ray_caster.h"

namespace railcast {
namespace {

// Share of the tolerance that may be added to the error of everything together.
constexpr double kMore = 0.2;

// All quantities of a deviation in a fixed order, first those over all echoes.
std::vector<double> ValuesOf(const Deviation& deviation) {
  std::vector<double> values;
  for (const DeviationQuantity& q : kDeviationQuantities) values.push_back(deviation.*q.value);
  for (const PartDeviation& part : deviation.parts) {
    for (const PartQuantity& q : kPartQuantities) {
      if (Counts(q, part)) values.push_back((part.*q.value).least);
    }
  }
  return values;
}

// So much of the tolerance, or more where everything together reaches it almost: from
// margin - kMore of the tolerance on. In parts, the lower ends of intervals are compared with these
// limits, which come from the error itself.
std::vector<double> LimitsFor(const ToleranceSpec& tolerance,
                              const Deviation& full,
                              double margin) {
  const auto limit = [margin](double tolerated, double reached) {
    return std::max(margin * tolerated, reached + kMore * tolerated);
  };
  std::vector<double> limits;
  for (const DeviationQuantity& q : kDeviationQuantities) {
    limits.push_back(limit(tolerance.*q.limit, full.*q.value));
  }
  for (const PartDeviation& part : full.parts) {
    for (const PartQuantity& q : kPartQuantities) {
      if (!Counts(q, part)) continue;
      limits.push_back(limit(tolerance.*q.limit, (part.*q.value).value));
    }
  }
  return limits;
}

// By how much values exceed the limits: the sum of excess over limit.
double Excess(const std::vector<double>& values, const std::vector<double>& limits) {
  constexpr double kLeastLimit = 1e-9;  // Avoids a division by a tolerance of 0.
  double excess = 0.0;
  for (std::size_t i = 0; i < values.size(); ++i) {
    // Both are infinite where no set has intensities.
    if (values[i] <= limits[i]) continue;
    excess += (values[i] - limits[i]) / std::max(limits[i], kLeastLimit);
  }
  return excess;
}

// What each candidate adds to each quantity when it is left out. By chance a deviation may also
// shrink; that counts as 0, since it does not justify leaving out something else.
std::vector<std::vector<double>> GrowthsOf(const EffectSearchResult& result) {
  const std::vector<double> full = ValuesOf(result.full_deviation);
  std::vector<std::vector<double>> growths;
  for (const Deviation& without : result.without) {
    std::vector<double> growth = ValuesOf(without);
    for (std::size_t i = 0; i < growth.size(); ++i) {
      growth[i] = std::isnan(growth[i] - full[i]) ? 0.0 : std::max(growth[i] - full[i], 0.0);
    }
    growths.push_back(std::move(growth));
  }
  return growths;
}

// The set that saves most, predicted by adding up the changes that each candidate causes alone.
Omissions PredictLeftOut(const EffectSearchResult& result,
                         const std::vector<double>& savings,
                         const std::vector<double>& limits) {
  const std::vector<double> full = ValuesOf(result.full_deviation);
  const std::vector<std::vector<double>> growths = GrowthsOf(result);
  Omissions best = 0;
  double best_saving = -1.0;
  for (Omissions bits = 0; bits < 1U << savings.size(); ++bits) {
    double saving = 0.0;
    std::vector<double> sum = full;
    for (std::size_t i = 0; i < savings.size(); ++i) {
      if (!IsIn(bits, i)) continue;
      saving += savings[i];
      for (std::size_t q = 0; q < sum.size(); ++q) sum[q] += growths[i][q];
    }
    if (saving > best_saving && Excess(sum, limits) == 0.0) {
      best = bits;
      best_saving = saving;
    }
  }
  return best;
}

// Puts back the candidate that leads nearest to the limits, or the cheaper of two alike.
void PutOneBack(const std::vector<double>& savings,
                const std::vector<double>& limits,
                const MeasureOmissions& measure,
                EffectSearchResult& result) {
  std::vector<Omissions> fewer;
  std::vector<double> saved;
  for (std::size_t i = 0; i < savings.size(); ++i) {
    if (!IsIn(result.left_out, i)) continue;
    fewer.push_back(result.left_out & ~(1U << i));
    saved.push_back(savings[i]);
  }
  const std::vector<Deviation> deviations = measure(fewer);
  double least_excess = std::numeric_limits<double>::infinity();
  double least_saved = 0.0;
  result.left_out = 0;  // Unless a set with a finite excess is found.
  Deviation nearest = result.full_deviation;
  for (std::size_t i = 0; i < fewer.size(); ++i) {
    const double excess = Excess(ValuesOf(deviations[i]), limits);
    if (excess > least_excess || (excess == least_excess && saved[i] >= least_saved)) continue;
    least_excess = excess;
    least_saved = saved[i];
    result.left_out = fewer[i];
    nearest = deviations[i];
  }
  result.deviation = nearest;
}

SampledError SampledShare(const Matched& matched) {
  return {1.0 - matched.share(), LeastShare(matched.num_missed(), matched.num)};
}

SampledError SampledMedian(const MedianError& error) {
  return {std::isnan(error.median) ? 0.0 : error.median, error.least};
}

PartDeviation DeviationIn(const PartDifference& part) {
  return {part.part.name,
          part.part.kind != ScenePart::Kind::kRangeBin,
          part.reference_echoes.num,
          part.echoes.num,
          SampledShare(part.reference_echoes),
          SampledShare(part.echoes),
          SampledMedian(part.range_m),
          SampledMedian(part.intensity)};
}

bool IsPartWithin(const PartDeviation& part, const ToleranceSpec& tolerance) {
  return std::ranges::all_of(kPartQuantities, [&](const PartQuantity& quantity) {
    return !Counts(quantity, part) || (part.*quantity.value).least <= tolerance.*quantity.limit;
  });
}

}  // namespace

EffectSearchResult FindOmissions(const std::vector<double>& savings,
                                 const ToleranceSpec& tolerance,
                                 const MeasureOmissions& measure) {
  std::vector<Omissions> alone = {0};
  for (std::size_t i = 0; i < savings.size(); ++i) alone.push_back(1U << i);
  std::vector<Deviation> deviations = measure(alone);
  EffectSearchResult result;
  result.full_deviation = deviations.front();
  result.without.assign(deviations.begin() + 1, deviations.end());
  const std::vector<double> limits = LimitsFor(tolerance, result.full_deviation, kSearchMargin);
  result.left_out = PredictLeftOut(result, savings, limits);
  const auto measured = std::ranges::find(alone, result.left_out);
  result.deviation = measured != alone.end()
                         ? deviations[static_cast<std::size_t>(measured - alone.begin())]
                         : measure({result.left_out}).front();
  while (result.left_out != 0 && Excess(ValuesOf(result.deviation), limits) > 0.0) {
    PutOneBack(savings, limits, measure, result);
  }
  return result;
}

bool IsWithinOrAsFull(const Deviation& deviation,
                      const Deviation& full,
                      const ToleranceSpec& tolerance) {
  return Excess(ValuesOf(deviation), LimitsFor(tolerance, full, 1.0)) == 0.0;
}

double InstructionsOf(const EffectSet& effects, const BeamSpec& beam) {
  double sum = kInstructionsOfGeometry;
  double of_width = 0.0;
  for (const Effect& effect : EffectTable()) {
    if (!(effects.*effect.is_on)) continue;
    (effect.is_on == &EffectSet::footprint ? of_width : sum) += effect.instructions.value_or(0.0);
  }
  if (!effects.footprint) return sum;
  if (beam.footprint_rays < static_cast<int>(kNumSubRays)) of_width -= kInstructionsOfMoreSubRays;
  if (beam.footprint_of.empty()) return sum + of_width;
  return sum + kInstructionsOfChoosing + kShareOfChosen * of_width;
}

double SavingOf(const Effect& effect, const EffectSet& effects, const BeamSpec& beam) {
  EffectSet without = effects;
  without.*effect.is_on = false;
  BeamSpec sparse = beam;
  sparse.footprint_rays = static_cast<int>(kNumCrowdedSubRays);
  return InstructionsOf(effects, sparse) - InstructionsOf(without, sparse);
}

Deviation DeviationOf(const FrameDifference& difference) {
  const bool lacks_intensity =
      difference.echoes.num_matched > 0 && std::isnan(difference.intensity.median);
  const auto or_zero = [](double value) { return std::isnan(value) ? 0.0 : value; };
  Deviation deviation{or_zero(difference.range_m.median),
                      1.0 - difference.reference_echoes.share(),
                      1.0 - difference.echoes.share(),
                      1.0 - difference.thin.share(),
                      lacks_intensity ? std::numeric_limits<double>::infinity()
                                      : or_zero(difference.intensity.median),
                      {}};
  for (const PartDifference& part : difference.parts) {
    deviation.parts.push_back(DeviationIn(part));
  }
  return deviation;
}

bool IsWithin(const Deviation& deviation, const ToleranceSpec& tolerance) {
  const bool is_mean_within =
      std::ranges::all_of(kDeviationQuantities, [&](const DeviationQuantity& quantity) {
        return deviation.*quantity.value <= tolerance.*quantity.limit;
      });
  return is_mean_within && PartsBeyond(deviation, tolerance).empty();
}

std::vector<PartDeviation> PartsBeyond(const Deviation& deviation, const ToleranceSpec& tolerance) {
  std::vector<PartDeviation> beyond;
  for (const PartDeviation& part : deviation.parts) {
    if (!IsPartWithin(part, tolerance)) beyond.push_back(part);
  }
  return beyond;
}

}  // namespace railcast
