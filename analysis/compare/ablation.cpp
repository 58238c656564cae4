#include "analysis/compare/ablation.h"

#include <map>
#include <optional>
#include "core/detect/detector/effect_table.h"
#include "railcast/effects.h"

namespace railcast {
namespace {

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

std::vector<std::string> StudiedEffects(const EffectSet& effects) {
  std::vector<std::string> names;
  for (const Effect& effect : EffectTable()) {
    if (!ConflictIn(Switched(effects, effect))) names.emplace_back(effect.name);
  }
  return names;
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
        {effect.name, effects.*effect.is_on, std::nullopt, {}, Comparison(distances_m)});
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
      study.beams.Add(without.frame, with.frame);
      study.clouds.Add(study.clouds.Compare(without, with));
    }
  }
  simulator.Use(spec);
  return studies;
}

}  // namespace railcast
