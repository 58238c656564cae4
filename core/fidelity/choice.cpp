#include "core/fidelity/choice.h"

#include <algorithm>
#include <string>
#include <utility>

#include "core/base/error.h"
#include "core/fidelity/effect_costs.h"
#include "core/fidelity/effect_search.h"
#include "core/fidelity/frame_comparison.h"
#include "core/fidelity/sample_frames.h"
#include "core/fidelity/yardstick.h"
#include "core/scenario/effect_names.h"

namespace railcast {
namespace {

// Every second one is held back.
constexpr int kNumFrames = 6;
constexpr double kFrameSpacing_s = 0.5;

using Effect = bool EffectSet::*;

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

  /// Without any there is nothing to compare.
  [[nodiscard]] bool HasReferenceEchoes() const {
    return std::any_of(references_.begin(), references_.end(), [](const Frame& frame) {
      return std::count(frame.outcome.begin(), frame.outcome.end(), Outcome::kReturned) > 0;
    });
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

}  // namespace

FidelityChoice ChooseFidelity(Simulator& simulator,
                              const ScenarioSpec& scenario,
                              const ChoiceProgress& on_progress) {
  Check(scenario.fidelity == kAutoFidelity, "there is something to choose");
  FidelityChoice choice;
  Candidates candidates = FindCandidates(scenario, choice);
  const EffectSet reference = ReferenceOf(candidates.full);
  // References take nearly all of the time.
  constexpr double kSampleShare = 0.45;
  constexpr double kMeasureShare = 0.1;
  on_progress(0.0);
  Comparer comparer(simulator, scenario);
  const auto frames = SampleFrames(scenario, simulator, kNumFrames, kFrameSpacing_s);
  for (std::size_t i = 0; i < frames.size(); i += 2) choice.sample_frames.push_back(frames[i]);
  comparer.UseFrames(choice.sample_frames, reference);
  on_progress(kSampleShare);
  choice.has_echoes = comparer.HasReferenceEchoes();
  if (!choice.has_echoes) candidates.all.clear();
  const EffectSearchResult found =
      FindCheapestEffects(candidates.full, candidates.all, scenario.tolerance,
                          [&](const EffectSet& effects) { return comparer.Measure(effects); });
  choice.effects = found.effects;
  choice.deviation = found.deviation;
  choice.full_deviation = found.full_deviation;
  choice.is_within_tolerance = IsWithin(choice.deviation, scenario.tolerance);
  choice.instructions = InstructionsOf(choice.effects);
  choice.full_instructions = InstructionsOf(candidates.full);
  for (std::size_t i = 0; i < candidates.all.size(); ++i) {
    const Effect effect = candidates.all[i].effect;
    choice.measured.push_back({NameOf(effect), found.effects.*effect, found.without[i]});
  }
  on_progress(kSampleShare + kMeasureShare);
  for (std::size_t i = 1; i < frames.size(); i += 2) {
    comparer.UseFrames({frames[i]}, reference);
    const Deviation deviation = comparer.Measure(choice.effects);
    choice.held_back.push_back({frames[i], deviation, IsWithin(deviation, scenario.tolerance)});
  }
  return choice;
}

FidelityChoice UseChosenFidelity(Simulator& simulator,
                                 const ScenarioSpec& scenario,
                                 const ChoiceProgress& on_progress) {
  FidelityChoice choice = ChooseFidelity(simulator, scenario, on_progress);
  SimulatorSpec spec = simulator.spec();
  spec.effects = choice.effects;
  simulator.Use(spec);
  return choice;
}

}  // namespace railcast
