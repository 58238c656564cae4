#include "core/fidelity/choice.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>
#include <utility>

#include "core/base/error.h"
#include "core/fidelity/effect_costs.h"
#include "core/fidelity/sample_frames.h"
#include "core/fidelity/yardstick.h"
#include "core/scenario/effect_names.h"

namespace railcast {
namespace {

constexpr int kNumSampleFrames = 3;
constexpr int kNumHeldBackFrames = 3;

// A deviation's and its limit's place.
struct Quantity {
  double Deviation::*value;
  double ToleranceSpec::*limit;
};
constexpr Quantity kQuantities[] = {
    {&Deviation::range_m, &ToleranceSpec::range_m},
    {&Deviation::missed_share, &ToleranceSpec::missed_share},
    {&Deviation::false_share, &ToleranceSpec::false_share},
    {&Deviation::thin_missed_share, &ToleranceSpec::thin_missed_share},
    {&Deviation::intensity, &ToleranceSpec::intensity},
};

using Effect = bool EffectSet::*;

EffectSet Without(EffectSet effects, Effect effect) {
  effects.*effect = false;
  return effects;
}

bool HasCause(Effect effect, const ScenarioSpec& scenario) {
  const WeatherSpec& weather = scenario.weather;
  const ReceiverSpec& receiver = scenario.lidar.receiver;
  if (effect == &EffectSet::sensor_dropout) {
    return scenario.lidar.plausibility.dropout_probability > 0.0;
  }
  if (effect == &EffectSet::clutter) {
    return receiver.clutter_gain > 0.0 &&
           (weather.rain_rate_mmph > 0.0 || weather.snow_rate_mmph > 0.0);
  }
  if (effect == &EffectSet::fog_echo) {
    return weather.visibility_m.has_value() || weather.fog_density_per_m > 0.0;
  }
  if (effect == &EffectSet::sunlight) return weather.sun.illuminance_klx > 0.0;
  if (effect == &EffectSet::range_noise) {
    return receiver.range_noise_floor_m > 0.0 || receiver.range_noise_scale_m > 0.0;
  }
  if (effect == &EffectSet::channel_bias) return receiver.channel_bias_sigma_m > 0.0;
  return receiver.pointing_jitter_deg > 0.0;  // Effect pointing_jitter.
}

bool IsMeasured(Effect effect) {
  return std::any_of(std::begin(kEffectCosts), std::end(kEffectCosts),
                     [&](const EffectCost& cost) { return cost.effect == effect; });
}

std::string NameOf(Effect effect) {
  for (const auto& [name, member] : kEffects) {
    if (member == effect) return name;
  }
  return {};
}

/// What is to be chosen from.
struct Candidates {
  EffectSet full;               // With all of them on.
  std::vector<EffectCost> all;  // Those that may be left out.
};

Candidates FindCandidates(const ScenarioSpec& scenario, FidelityChoice& choice) {
  Candidates candidates{SwitchedEffects(scenario), {}};
  for (const auto& [name, effect] : kEffects) {
    if (!(candidates.full.*effect)) continue;
    const bool is_switched_on = scenario.effects.count(name) > 0;
    if (!is_switched_on && IsMeasured(effect)) continue;
    if (is_switched_on || HasCause(effect, scenario)) {
      choice.kept.emplace_back(name);
    } else {
      choice.without_cause.emplace_back(name);
      candidates.full.*effect = false;
    }
  }
  for (const EffectCost& cost : kEffectCosts) {
    if (candidates.full.*cost.effect && scenario.effects.count(NameOf(cost.effect)) == 0) {
      candidates.all.push_back(cost);
    }
  }
  return candidates;
}

// The same effects, as many rays as the reference has.
EffectSet ReferenceOf(EffectSet effects) {
  if (effects.footprint) {
    effects.thin_conductors = false;
    effects.dense_footprint = true;
    effects.sampled_waveform = true;
  }
  return effects;
}

/// Scans frames with one set after another and compares them with the reference's.
class Comparer {
 public:
  Comparer(Simulator& simulator, const ScenarioSpec& scenario)
      : simulator_(simulator),
        spec_(simulator.spec()),
        comparison_(MakeComparisonSpec(
            scenario.lidar.beam, scenario.lidar.range_max_m, LabelTable(scenario.labels))) {}
  ~Comparer() { simulator_.Use(spec_); }
  Comparer(const Comparer&) = delete;
  Comparer& operator=(const Comparer&) = delete;

  void UseFrames(const std::vector<std::uint32_t>& frames, const EffectSet& reference) {
    frames_ = frames;
    references_.resize(frames.size());
    for (std::size_t i = 0; i < frames.size(); ++i) Scan(frames[i], reference, references_[i]);
  }

  [[nodiscard]] Deviation Measure(const EffectSet& effects) {
    FrameComparison comparison(comparison_);
    Frame frame;
    for (std::size_t i = 0; i < frames_.size(); ++i) {
      Scan(frames_[i], effects, frame);
      comparison.Add(references_[i], frame);
    }
    return DeviationOf(comparison.Result());
  }

 private:
  void Scan(std::uint32_t index, const EffectSet& effects, Frame& frame) {
    SimulatorSpec spec = spec_;
    spec.effects = WithoutRangeErrors(effects);
    simulator_.Use(spec);
    simulator_.Scan(index, frame);
  }

  Simulator& simulator_;
  SimulatorSpec spec_;
  ComparisonSpec comparison_;
  std::vector<std::uint32_t> frames_;
  std::vector<Frame> references_;
};

// What leaving an effect out adds to the deviation: it may also take some away by chance, which is
// no reason to leave out another.
double Growth(const Deviation& without, const Deviation& full, const Quantity& quantity) {
  const double growth = without.*quantity.value - full.*quantity.value;
  return std::isnan(growth) ? 0.0 : std::max(growth, 0.0);
}

// The limits, and where all effects together do not reach one, little more than what they reach.
ToleranceSpec ReachableLimits(ToleranceSpec tolerance, const Deviation& full) {
  constexpr double kLittle = 0.1;  // Of the limit.
  for (const Quantity& quantity : kQuantities) {
    double& limit = tolerance.*quantity.limit;
    limit = std::max(limit, full.*quantity.value + kLittle * limit);
  }
  return tolerance;
}

bool IsPredictedWithin(const std::vector<Deviation>& without,
                       unsigned left_out,
                       const Deviation& full,
                       const ToleranceSpec& limits) {
  return std::all_of(std::begin(kQuantities), std::end(kQuantities), [&](const Quantity& quantity) {
    double sum = full.*quantity.value;
    for (std::size_t i = 0; i < without.size(); ++i) {
      if ((left_out >> i & 1U) != 0) sum += Growth(without[i], full, quantity);
    }
    return sum <= limits.*quantity.limit;
  });
}

// The dearest effects that may go together by their single deviations, as bits.
unsigned ChooseLeftOut(const Candidates& candidates,
                       const std::vector<Deviation>& without,
                       const Deviation& full,
                       const ToleranceSpec& limits) {
  unsigned best = 0;
  double best_saving = 0.0;
  for (unsigned set = 1; set < 1U << candidates.all.size(); ++set) {
    double saving = 0.0;
    for (std::size_t i = 0; i < candidates.all.size(); ++i) {
      if ((set >> i & 1U) != 0) saving += candidates.all[i].instructions;
    }
    if (saving > best_saving && IsPredictedWithin(without, set, full, limits)) {
      best = set;
      best_saving = saving;
    }
  }
  return best;
}

// Which of the left out effects weighs most in what is beyond the limits.
std::size_t MostMissed(unsigned left_out,
                       const std::vector<Deviation>& without,
                       const FidelityChoice& choice,
                       const ToleranceSpec& limits) {
  std::size_t most = 0;
  double most_weight = -1.0;
  for (std::size_t i = 0; i < without.size(); ++i) {
    if ((left_out >> i & 1U) == 0) continue;
    double weight = 0.0;
    for (const Quantity& quantity : kQuantities) {
      const double limit = limits.*quantity.limit;
      if (choice.deviation.*quantity.value <= limit) continue;
      constexpr double kLeastLimit = 1e-9;
      weight += Growth(without[i], choice.full_deviation, quantity) / std::max(limit, kLeastLimit);
    }
    if (weight > most_weight) {
      most = i;
      most_weight = weight;
    }
  }
  return most;
}

EffectSet Remaining(const Candidates& candidates, unsigned left_out) {
  EffectSet effects = candidates.full;
  for (std::size_t i = 0; i < candidates.all.size(); ++i) {
    if ((left_out >> i & 1U) != 0) effects.*candidates.all[i].effect = false;
  }
  return effects;
}

}  // namespace

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
  return std::all_of(std::begin(kQuantities), std::end(kQuantities), [&](const Quantity& quantity) {
    return deviation.*quantity.value <= tolerance.*quantity.limit;
  });
}

FidelityChoice ChooseFidelity(Simulator& simulator,
                              const ScenarioSpec& scenario,
                              const ChoiceProgress& on_progress) {
  Check(scenario.fidelity == kAutoFidelity, "there is something to choose");
  FidelityChoice choice;
  const Candidates candidates = FindCandidates(scenario, choice);
  const EffectSet reference = ReferenceOf(candidates.full);
  // References take nearly all of the time.
  constexpr double kSampleShare = 0.45;
  constexpr double kMeasureShare = 0.1;
  on_progress(0.0);
  Comparer comparer(simulator, scenario);
  choice.sample_frames = SampleFrames(simulator.pattern(), kNumSampleFrames);
  comparer.UseFrames(choice.sample_frames, reference);
  on_progress(kSampleShare);
  choice.full_deviation = comparer.Measure(candidates.full);
  std::vector<Deviation> without;
  for (const EffectCost& cost : candidates.all) {
    without.push_back(comparer.Measure(Without(candidates.full, cost.effect)));
  }
  const ToleranceSpec limits = ReachableLimits(scenario.tolerance, choice.full_deviation);
  unsigned left_out = ChooseLeftOut(candidates, without, choice.full_deviation, limits);
  choice.deviation = comparer.Measure(Remaining(candidates, left_out));
  while (left_out != 0 && !IsWithin(choice.deviation, limits)) {
    left_out &= ~(1U << MostMissed(left_out, without, choice, limits));
    choice.deviation = comparer.Measure(Remaining(candidates, left_out));
  }
  choice.effects = Remaining(candidates, left_out);
  choice.is_within_tolerance = IsWithin(choice.deviation, scenario.tolerance);
  choice.instructions = InstructionsOf(choice.effects);
  choice.full_instructions = InstructionsOf(candidates.full);
  for (std::size_t i = 0; i < without.size(); ++i) {
    choice.measured.push_back(
        {NameOf(candidates.all[i].effect), (left_out >> i & 1U) == 0, without[i]});
  }
  on_progress(kSampleShare + kMeasureShare);
  for (const std::uint32_t frame : SampleFrames(simulator.pattern(), kNumHeldBackFrames, 0.5)) {
    comparer.UseFrames({frame}, reference);
    const Deviation deviation = comparer.Measure(choice.effects);
    choice.held_back.push_back({frame, deviation, IsWithin(deviation, scenario.tolerance)});
  }
  return choice;
}

}  // namespace railcast
