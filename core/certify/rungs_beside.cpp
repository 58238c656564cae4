#include "core/certify/rungs_beside.h"

#include "core/detect/detector/effect_table.h"
#include "core/fidelity/effect_search.h"
#include "core/fidelity/frame_comparison.h"

namespace railcast {
namespace {

// What a sub-ray of rung `reference` takes, and what all else does that is done for a firing:
// measured on scenarios/st_gallen_approach.json, where a frame of `geometry` takes 17 ms on one
// thread, one of `footprint` 172 ms and one of `reference` 3,970 ms, of which 0.1 us a firing are
// for its encoding and writing.
constexpr double kInstructionsOfReferenceRay = 1.1 * kInstructionsOfGeometry;
constexpr double kInstructionsOfWriting = 600.0;

}  // namespace

EffectSet EffectsAt(Fidelity rung, const ScenarioSpec& scenario) {
  EffectSet effects = EffectsInRung(rung);
  for (const auto& [name, is_on] : scenario.effects) {
    const Effect* const effect = FindEffect(name);
    if (effect == nullptr) continue;
    // What the reference is made of is no choice of the scenario: it would be compared with itself.
    const bool is_of_reference = effect->is_on == &EffectSet::dense_footprint ||
                                 effect->is_on == &EffectSet::sampled_waveform;
    if (rung == Fidelity::kReference && is_of_reference) continue;
    EffectSet switched = effects;
    switched.*effect->is_on = is_on;
    if (!ConflictIn(switched)) effects = switched;
  }
  return effects;
}

double InstructionsPerFiring(const EffectSet& effects, const BeamSpec& beam) {
  if (effects.dense_footprint) return beam.reference_rays * kInstructionsOfReferenceRay;
  return InstructionsOf(effects, beam) + kInstructionsOfWriting;
}

std::vector<RungBeside> RungsBeside(const ScenarioSpec& scenario, const DetectorSpec& own) {
  const double own_cost = InstructionsPerFiring(own.effects, own.beam);
  std::optional<RungBeside> cheaper;
  std::optional<RungBeside> dearer;
  for (const Fidelity rung : kRungs) {
    const EffectSet effects = EffectsAt(rung, scenario);
    const BeamSpec& beam = scenario.lidar.beam;
    // Fidelity `auto` may give fewer beams a width.
    const bool is_own = effects == own.effects && beam.footprint_of == own.beam.footprint_of;
    if (is_own || effects.dense_footprint) continue;
    const RungBeside beside{std::string(NameOf(rung)),
                            {.effects = WithoutRangeErrors(effects),
                             .footprint_rays = beam.footprint_rays,
                             .has_footprint_of = !beam.footprint_of.empty()},
                            InstructionsPerFiring(effects, beam) / own_cost};
    if (beside.cost < 1.0) cheaper = beside;
    if (beside.cost > 1.0 && !dearer) dearer = beside;
  }
  std::vector<RungBeside> rungs;
  if (cheaper) rungs.push_back(*cheaper);
  if (dearer) rungs.push_back(*dearer);
  return rungs;
}

}  // namespace railcast
