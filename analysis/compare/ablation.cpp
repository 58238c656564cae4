#include "analysis/compare/ablation.h"

#include <bit>
#include <cmath>
#include <map>

#include "analysis/stats/bins.h"
#include "core/base/error.h"
#include "core/detect/detector/effect_table.h"

namespace railcast {
namespace {

// Compares bits, so that NaN equals NaN.
bool IsSame(float a, float b) {
  return std::bit_cast<std::uint32_t>(a) == std::bit_cast<std::uint32_t>(b);
}

// Without an effect that computes it, the intensity is unknown (NaN), which is not a change.
bool IsSameIntensity(float a, float b) {
  return std::isnan(a) || std::isnan(b) || IsSame(a, b);
}

bool IsAtSamePlace(const Frame& a, const Frame& b, std::size_t slot) {
  return IsSame(a.x[slot], b.x[slot]) && IsSame(a.y[slot], b.y[slot]) &&
         IsSame(a.z[slot], b.z[slot]);
}

bool IsSameReturn(const Frame& a, const Frame& b, std::size_t slot) {
  return IsAtSamePlace(a, b, slot) && IsSameIntensity(a.intensity[slot], b.intensity[slot]) &&
         IsSame(a.range_m[slot], b.range_m[slot]) && a.outcome[slot] == b.outcome[slot];
}

double Moved_m(const Frame& a, const Frame& b, std::size_t slot) {
  const auto distance_m = [&](const std::vector<float>& from, const std::vector<float>& to) {
    return static_cast<double>(to[slot]) - static_cast<double>(from[slot]);
  };
  return std::hypot(distance_m(a.x, b.x), distance_m(a.y, b.y), distance_m(a.z, b.z));
}

void AddReturn(const Frame& without, const Frame& with, std::size_t slot, BeamChanges& changes) {
  const bool is_without = HasPoint(without.outcome[slot]);
  const bool is_with = HasPoint(with.outcome[slot]);
  if (is_without && !is_with) ++changes.num_removed;
  if (!is_without && is_with) ++changes.num_added;
  if (!is_without || !is_with) return;
  ++changes.num_both;
  if (!IsAtSamePlace(without, with, slot)) {
    ++changes.num_moved;
    changes.moved_m.Add(Moved_m(without, with, slot));
  }
  if (!IsSameIntensity(without.intensity[slot], with.intensity[slot])) {
    ++changes.num_intensity_changed;
    changes.intensity_change.Add(std::abs(static_cast<double>(with.intensity[slot]) -
                                          static_cast<double>(without.intensity[slot])));
  }
}

void AddFrame(const Frame& without, const Frame& with, EffectStudy& study) {
  BeamChanges& beams = study.beams;
  const auto num_points = [&] { return beams.num_removed + beams.num_added; };
  const auto num_beams_before = beams.num_beams;
  const auto num_outcomes_before = beams.num_outcome_changed;
  const auto num_points_before = num_points();
  beams.Add(without, with);
  const auto num_beams = static_cast<double>(beams.num_beams - num_beams_before);
  study.frames.push_back(
      {static_cast<double>(beams.num_outcome_changed - num_outcomes_before) / num_beams,
       static_cast<double>(num_points() - num_points_before) / num_beams});
}

EffectSet Switched(EffectSet effects, const Effect& effect) {
  effects.*effect.is_on = !(effects.*effect.is_on);
  return effects;
}

RecordedFrame Scanned(Simulator& simulator, const SimulatorSpec& spec, std::uint32_t index) {
  RecordedFrame recorded;
  simulator.Use(spec);
  simulator.Scan(index, recorded.frame);
  recorded.is_grid = true;
  ForEachField(recorded.frame,
               [&](const char* name, const char*, const auto&) { recorded.fields.emplace(name); });
  return recorded;
}

}  // namespace

BeamChanges::BeamChanges() : range_bins(RangeBins().size()) {}

void BeamChanges::Add(const Frame& without, const Frame& with) {
  Check(without.num_slots() == with.num_slots() && without.returns == with.returns,
        "frames with and without an effect are of one pattern");
  for (std::size_t first = 0; first < with.num_slots(); first += with.returns) {
    bool is_identical = true;
    for (std::size_t slot = first; slot < first + with.returns; ++slot) {
      is_identical = is_identical && IsSameReturn(without, with, slot);
      AddReturn(without, with, slot, *this);
    }
    const bool is_same_outcome = without.outcome[first] == with.outcome[first];
    ++num_beams;
    num_identical += is_identical ? 1 : 0;
    num_outcome_changed += is_same_outcome ? 0 : 1;
    ++transitions[static_cast<std::size_t>(without.outcome[first])]
                 [static_cast<std::size_t>(with.outcome[first])];
    const float true_range_m = std::isfinite(without.true_range_m[first])
                                   ? without.true_range_m[first]
                                   : with.true_range_m[first];
    if (const auto bin = RangeBins().Find(static_cast<double>(true_range_m))) {
      ++range_bins[*bin].num_beams;
      range_bins[*bin].num_changed += is_identical ? 0 : 1;
      range_bins[*bin].num_outcome_changed += is_same_outcome ? 0 : 1;
    }
  }
}

std::vector<EffectStudy> Ablate(Simulator& simulator,
                                const std::vector<std::uint32_t>& frames,
                                const std::vector<double>& distances_m,
                                const AblationProgress& on_progress,
                                StudyScope scope) {
  const SimulatorSpec spec = simulator.spec();
  const EffectSet& effects = spec.detector.effects;
  std::vector<EffectStudy> studies;
  for (const Effect& effect : EffectTable()) {
    const bool is_compatible = !ConflictIn(Switched(effects, effect));
    if (!is_compatible && scope == StudyScope::kCompatible) continue;
    studies.push_back(
        {effect.name, effects.*effect.is_on, std::nullopt, {}, {}, Comparison(distances_m)});
    if (!is_compatible) studies.back().rung = effect.rungs.front();
  }
  const double num_steps = static_cast<double>(frames.size() * studies.size());
  double num_done = 0.0;
  for (const std::uint32_t index : frames) {
    const auto scanned = [&](const EffectSet& with) {
      SimulatorSpec switched = spec;
      switched.detector.effects = with;
      return Scanned(simulator, switched, index);
    };
    // The frame without any effect switched, of the scenario (no rung) and of rungs.
    std::map<std::optional<Fidelity>, RecordedFrame> as_is;
    for (EffectStudy& study : studies) {
      on_progress("frame " + std::to_string(index) + ", " + study.effect, num_done++ / num_steps);
      const Effect& effect = *FindEffect(study.effect);
      const EffectSet base = study.rung ? EffectsInRung(*study.rung) : effects;
      if (!as_is.contains(study.rung)) as_is.emplace(study.rung, scanned(base));
      const RecordedFrame& unswitched = as_is.at(study.rung);
      std::optional<RecordedFrame> switched;
      if (effect.has_cause(spec.detector)) switched = scanned(Switched(base, effect));
      const RecordedFrame& other = switched ? *switched : unswitched;
      const bool is_with = base.*effect.is_on;
      const RecordedFrame& without = is_with ? other : unswitched;
      const RecordedFrame& with = is_with ? unswitched : other;
      AddFrame(without.frame, with.frame, study);
      study.clouds.Add(study.clouds.Compare(without, with));
    }
  }
  simulator.Use(spec);
  return studies;
}

}  // namespace railcast
