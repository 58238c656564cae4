#include "railcast/fidelity.h"

#include <algorithm>
#include <functional>
#include <optional>
#include <string>
#include <utility>

#include "core/base/error.h"
#include "core/detect/detector/effect_table.h"
#include "core/fidelity/effect_search.h"
#include "core/fidelity/frame_comparison.h"
#include "core/fidelity/sample_frames.h"
#include "railcast/effects.h"
#include "railcast/ray_caster.h"

namespace railcast {
namespace {

// Every second of the frames spread over the run is held back from the search, to validate its
// result.
constexpr int kNumSpread = 6;
constexpr int kMostAtObjects = 4;

struct Frames {
  std::vector<std::uint32_t> samples;
  std::vector<std::uint32_t> held_back;
};

Frames ChooseFrames(const ScenarioSpec& scenario, const Simulator& simulator) {
  const std::uint32_t last = LastFrameOfRun(scenario, simulator, kNumSpread);
  const std::vector<std::uint32_t> spread = SpreadFrames(last, kNumSpread);
  Frames frames;
  for (std::size_t i = 0; i < spread.size(); ++i) {
    (i % 2 == 0 ? frames.samples : frames.held_back).push_back(spread[i]);
  }
  for (const std::uint32_t frame : FramesAtObjects(scenario, simulator, last, kMostAtObjects)) {
    if (std::ranges::find(spread, frame) == spread.end()) frames.samples.push_back(frame);
  }
  std::ranges::sort(frames.samples);
  return frames;
}

/// Something that may be left out.
struct Omittable {
  std::string name;
  double saving;           // Instructions per firing.
  const Effect* effect{};  // Null for the larger number of sub-rays.
};

/// The candidates among which the search chooses.
struct Candidates {
  EffectSet full;  // The set with all of them on.
  BeamSpec beam;   // With all sub-rays.
  std::vector<Omittable> all;

  [[nodiscard]] EffectSet Without(Omissions left_out) const {
    EffectSet effects = full;
    for (std::size_t i = 0; i < all.size(); ++i) {
      if (IsIn(left_out, i) && all[i].effect != nullptr) effects.*all[i].effect->is_on = false;
    }
    return effects;
  }
  [[nodiscard]] int RaysWithout(Omissions left_out) const {
    for (std::size_t i = 0; i < all.size(); ++i) {
      if (IsIn(left_out, i) && all[i].effect == nullptr) {
        return static_cast<int>(kNumCrowdedSubRays);
      }
    }
    return beam.footprint_rays;
  }
};

// Without a threshold everything far away would return. That it costs little is no reason either:
// it belongs to the task.
bool MayBeLeftOut(const Effect& effect) {
  return effect.instructions && effect.is_on != &EffectSet::detection;
}

Candidates FindCandidates(const ScenarioSpec& scenario, FidelityChoice& choice) {
  Candidates candidates{SwitchedEffects(scenario), scenario.lidar.beam, {}};
  BeamSpec& beam = candidates.beam;
  beam.footprint_of = choice.footprint_of;
  EffectSet& full = candidates.full;
  const DetectorSpec spec = DetectorSpecOf(scenario, scenario.lidar, full);
  const auto is_switched_on = [&](const Effect& effect) {
    return scenario.effects.count(effect.name) > 0;
  };
  for (const Effect& effect : EffectTable()) {
    if (!(full.*effect.is_on) || is_switched_on(effect) || effect.has_cause(spec)) continue;
    choice.without_cause.emplace_back(effect.name);
    full.*effect.is_on = false;
  }
  choice.full_instructions = InstructionsOf(full, beam);
  // What saves less than this is not worth any error.
  constexpr double kNextToNothing = 0.01;
  const double least_saving = kNextToNothing * choice.full_instructions;
  for (const Effect& effect : EffectTable()) {
    if (!(full.*effect.is_on)) continue;
    const double saving = SavingOf(effect, full, beam);
    if (is_switched_on(effect) || !MayBeLeftOut(effect) || saving < least_saving) {
      choice.kept.emplace_back(effect.name);
    } else {
      candidates.all.push_back({effect.name, saving, &effect});
    }
  }
  if (full.footprint && !full.dense_footprint &&
      beam.footprint_rays > static_cast<int>(kNumCrowdedSubRays)) {
    BeamSpec sparse = beam;
    sparse.footprint_rays = static_cast<int>(kNumCrowdedSubRays);
    candidates.all.push_back({std::to_string(beam.footprint_rays) + " sub-rays",
                              choice.full_instructions - InstructionsOf(full, sparse), nullptr});
  }
  return candidates;
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

// The spec with the width of beams that was chosen.
SimulatorSpec WithWidthOf(const FidelityChoice& choice,
                          const ScenarioSpec& scenario,
                          SimulatorSpec spec) {
  spec.detector.beam.footprint_of = choice.footprint_of;
  spec.detector.footprint_labels =
      LabelTable(scenario.labels).Ids(choice.footprint_of, "/tolerance/of");
  return spec;
}

// Only the classes of objects: the task is not about grass.
ComparisonSpec ComparisonOf(const ScenarioSpec& scenario, const World& world) {
  ComparisonSpec spec = MakeComparisonSpec(scenario.lidar.beam, scenario.lidar.range_max_m,
                                           LabelTable(scenario.labels), world.objects());
  std::erase_if(spec.parts, [&](const ScenePart& part) {
    return part.kind == ScenePart::Kind::kClass &&
           std::ranges::find(world.objects(), part.id, &SceneObject::label) ==
               world.objects().end();
  });
  spec.labels = LabelTable(scenario.labels).Ids(scenario.tolerance.of, "/tolerance/of");
  return spec;
}

/// Scans frames with one setting after another and compares them with those of the reference.
class Comparer {
 public:
  /// @param spec The simulator's, with other beams.
  Comparer(Simulator& simulator,
           const ScenarioSpec& scenario,
           const SimulatorSpec& spec,
           const EffectSet& reference)
      : simulator_(simulator),
        own_spec_(simulator.spec()),
        spec_(spec),
        reference_(reference),
        comparison_(ComparisonOf(scenario, simulator.world())) {}
  ~Comparer() { simulator_.Use(own_spec_); }
  Comparer(const Comparer&) = delete;
  Comparer& operator=(const Comparer&) = delete;

  /// @param on_reference Called before the scan of each frame of the reference.
  void UseFrames(const std::vector<std::uint32_t>& frames,
                 const std::function<void()>& on_reference) {
    frames_ = frames;
    on_reference_ = on_reference;
    references_.assign(frames.size(), std::nullopt);
  }

  /// All sets take their turns on one frame before the next, which may need a window of its own.
  [[nodiscard]] std::vector<Deviation> Measure(const Candidates& candidates,
                                               const std::vector<Omissions>& sets) {
    std::vector<FrameComparison> comparisons(sets.size(), FrameComparison(comparison_));
    Frame frame;
    for (std::size_t i = 0; i < frames_.size(); ++i) {
      if (!references_[i]) {
        on_reference_();
        Scan(frames_[i], reference_, candidates.beam.footprint_rays, references_[i].emplace());
      }
      for (std::size_t k = 0; k < sets.size(); ++k) {
        Scan(frames_[i], candidates.Without(sets[k]), candidates.RaysWithout(sets[k]), frame);
        comparisons[k].Add(*references_[i], frame);
      }
    }
    std::vector<Deviation> deviations;
    for (const FrameComparison& of_set : comparisons) {
      const FrameDifference difference = of_set.Result();
      has_reference_echoes_ = has_reference_echoes_ || difference.reference_echoes.num > 0;
      deviations.push_back(DeviationOf(difference));
    }
    return deviations;
  }

  /// Whether the reference has had any echo of what is compared. If not, nothing can be said.
  [[nodiscard]] bool HasReferenceEchoes() const { return has_reference_echoes_; }

 private:
  void Scan(std::uint32_t index, const EffectSet& effects, int footprint_rays, Frame& frame) {
    SimulatorSpec spec = spec_;
    spec.detector.effects = WithoutRangeErrors(effects);
    spec.detector.beam.footprint_rays = footprint_rays;
    simulator_.Use(spec);
    simulator_.Scan(index, frame);
  }

  Simulator& simulator_;
  SimulatorSpec own_spec_;
  SimulatorSpec spec_;
  EffectSet reference_;
  ComparisonSpec comparison_;
  std::vector<std::uint32_t> frames_;
  std::function<void()> on_reference_;
  std::vector<std::optional<Frame>> references_;
  bool has_reference_echoes_ = false;
};

void Store(const EffectSearchResult& found,
           const Candidates& candidates,
           const ToleranceSpec& tolerance,
           FidelityChoice& choice) {
  choice.effects = candidates.Without(found.left_out);
  BeamSpec beam = candidates.beam;
  beam.footprint_rays = choice.footprint_rays = candidates.RaysWithout(found.left_out);
  choice.deviation = found.deviation;
  choice.full_deviation = found.full_deviation;
  choice.is_within_tolerance = IsWithin(choice.deviation, tolerance);
  choice.instructions = InstructionsOf(choice.effects, beam);
  for (std::size_t i = 0; i < candidates.all.size(); ++i) {
    choice.measured.push_back({candidates.all[i].name, !IsIn(found.left_out, i), found.without[i]});
  }
}

}  // namespace

FidelityChoice ChooseFidelity(Simulator& simulator,
                              const ScenarioSpec& scenario,
                              const ChoiceProgress& on_progress) {
  Check(scenario.fidelity == Fidelity::kAuto, "there is something to choose");
  FidelityChoice choice;
  choice.tolerance = scenario.tolerance;
  const std::vector<std::string>& own = scenario.lidar.beam.footprint_of;
  choice.footprint_of = own.empty() ? scenario.tolerance.of : own;
  choice.has_full_detail =
      simulator.spec().has_full_detail || simulator.spec().detector.effects.dense_footprint;
  const Candidates candidates = FindCandidates(scenario, choice);
  const Frames frames = ChooseFrames(scenario, simulator);
  choice.sample_frames = frames.samples;
  // Scanning the reference frames takes nearly all of the time.
  const auto num_references = static_cast<double>(frames.samples.size() + frames.held_back.size());
  int num_done = 0;
  const auto advance = [&] { on_progress(num_done++ / num_references); };
  Comparer comparer(simulator, scenario, WithWidthOf(choice, scenario, simulator.spec()),
                    ReferenceOf(candidates.full));
  comparer.UseFrames(frames.samples, advance);
  std::vector<double> savings;
  for (const Omittable& candidate : candidates.all) savings.push_back(candidate.saving);
  EffectSearchResult found = FindOmissions(
      savings, scenario.tolerance,
      [&](const std::vector<Omissions>& sets) { return comparer.Measure(candidates, sets); });
  choice.has_echoes = comparer.HasReferenceEchoes();
  if (!choice.has_echoes) {
    found.left_out = 0;
    found.deviation = found.full_deviation;
  }
  Store(found, candidates, scenario.tolerance, choice);
  for (const std::uint32_t frame : frames.held_back) {
    comparer.UseFrames({frame}, advance);
    const std::vector<Deviation> chosen_and_full =
        comparer.Measure(candidates, {found.left_out, Omissions{0}});
    choice.held_back.push_back(
        {frame, chosen_and_full[0],
         IsWithinOrAsFull(chosen_and_full[0], chosen_and_full[1], scenario.tolerance)});
  }
  return choice;
}

FidelityChoice UseChosenFidelity(Simulator& simulator,
                                 const ScenarioSpec& scenario,
                                 const ChoiceProgress& on_progress) {
  FidelityChoice choice = ChooseFidelity(simulator, scenario, on_progress);
  SimulatorSpec spec = WithWidthOf(choice, scenario, simulator.spec());
  spec.detector.effects = choice.effects;
  spec.detector.beam.footprint_rays = choice.footprint_rays;
  simulator.Use(spec);
  return choice;
}

}  // namespace railcast
