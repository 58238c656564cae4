#include "analysis/compare/ablation.h"

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
                                const AblationProgress& on_progress) {
  const SimulatorSpec spec = simulator.spec();
  std::vector<EffectStudy> studies;
  const EffectSet& effects = spec.detector.effects;
  for (const std::string& name : StudiedEffects(effects)) {
    studies.push_back({name, effects.*FindEffect(name)->is_on, {}, Comparison(distances_m)});
  }
  const double num_steps = static_cast<double>(frames.size() * studies.size());
  double num_done = 0.0;
  for (const std::uint32_t index : frames) {
    const RecordedFrame as_is = Scanned(simulator, spec, index);
    for (EffectStudy& study : studies) {
      on_progress("frame " + std::to_string(index) + ", " + study.effect, num_done++ / num_steps);
      SimulatorSpec switched = spec;
      switched.detector.effects = Switched(effects, *FindEffect(study.effect));
      const RecordedFrame other = Scanned(simulator, switched, index);
      const RecordedFrame& without = study.is_in_scenario ? other : as_is;
      const RecordedFrame& with = study.is_in_scenario ? as_is : other;
      study.beams.Add(without.frame, with.frame);
      study.clouds.Add(study.clouds.Compare(without, with));
    }
  }
  simulator.Use(spec);
  return studies;
}

}  // namespace railcast
