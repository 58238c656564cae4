#include "railcast/fidelity.h"

#include <algorithm>
#include <string>
#include <utility>

#include "core/base/error.h"
#include "core/detect/effect_table.h"
#include "core/fidelity/effect_search.h"
#include "core/fidelity/frame_comparison.h"
#include "core/fidelity/sample_frames.h"
#include "core/fidelity/yardstick.h"
#include "railcast/effects.h"

namespace railcast {
namespace {

// Every second frame is held back from the search, to validate its result.
constexpr int kNumFrames = 6;
constexpr double kFrameSpacing_s = 0.5;

/// The effects among which the search chooses.
struct Candidates {
  EffectSet full;                  // The set with all of them on.
  std::vector<const Effect*> all;  // The effects that may be left out.
};

Candidates FindCandidates(const ScenarioSpec& scenario, FidelityChoice& choice) {
  Candidates candidates{SwitchedEffects(scenario), {}};
  const DetectorSpec spec = DetectorSpecOf(scenario, scenario.lidar, candidates.full);
  for (const Effect& effect : EffectTable()) {
    if (!(candidates.full.*effect.is_on)) continue;
    const bool is_switched_on = scenario.effects.count(effect.name) > 0;
    if (!is_switched_on && effect.instructions) {
      candidates.all.push_back(&effect);
    } else if (is_switched_on || effect.has_cause(spec)) {
      choice.kept.emplace_back(effect.name);
    } else {
      choice.without_cause.emplace_back(effect.name);
      candidates.full.*effect.is_on = false;
    }
  }
  return candidates;
}

std::vector<EffectCost> CostsOf(const std::vector<const Effect*>& effects) {
  std::vector<EffectCost> costs;
  for (const Effect* effect : effects) costs.push_back({effect->is_on, *effect->instructions});
  return costs;
}

// The same effects, but where the rungs `footprint` and `reference` differ, as `reference` has it:
// many more rays.
EffectSet ReferenceOf(EffectSet effects) {
  if (!effects.footprint) return effects;
  for (const Effect& effect : EffectTable()) {
    const bool is_in_reference = IsInRung(effect, Fidelity::kReference);
    if (is_in_reference != IsInRung(effect, Fidelity::kFootprint)) {
      effects.*effect.is_on = is_in_reference;
    }
  }
  return effects;
}

/// Scans frames with one effect set after another and compares them with those of the reference.
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

  /// Whether the reference has any echo. If not, there is nothing to compare.
  [[nodiscard]] bool HasReferenceEchoes() const {
    return std::any_of(references_.begin(), references_.end(), [](const Frame& frame) {
      return std::count(frame.outcome.begin(), frame.outcome.end(), Outcome::kReturned) > 0;
    });
  }

 private:
  void Scan(std::uint32_t index, const EffectSet& effects, Frame& frame) {
    SimulatorSpec spec = spec_;
    spec.detector.effects = WithoutRangeErrors(effects);
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
  Check(scenario.fidelity == Fidelity::kAuto, "there is something to choose");
  FidelityChoice choice;
  Candidates candidates = FindCandidates(scenario, choice);
  const EffectSet reference = ReferenceOf(candidates.full);
  // Shares of the progress: scanning the reference frames takes nearly all of the time.
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
      FindCheapestEffects(candidates.full, CostsOf(candidates.all), scenario.tolerance,
                          [&](const EffectSet& effects) { return comparer.Measure(effects); });
  choice.effects = found.effects;
  choice.deviation = found.deviation;
  choice.full_deviation = found.full_deviation;
  choice.is_within_tolerance = IsWithin(choice.deviation, scenario.tolerance);
  choice.instructions = InstructionsOf(choice.effects);
  choice.full_instructions = InstructionsOf(candidates.full);
  for (std::size_t i = 0; i < candidates.all.size(); ++i) {
    const Effect& effect = *candidates.all[i];
    choice.measured.push_back({effect.name, found.effects.*effect.is_on, found.without[i]});
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
  spec.detector.effects = choice.effects;
  simulator.Use(spec);
  return choice;
}

}  // namespace railcast
