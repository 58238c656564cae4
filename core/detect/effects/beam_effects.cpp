// The table rows of the effects of the beam's width. They have no loop in the detector: they decide
// what is traced (core/simulate/beam_tracer.h) and how echoes are found in it (footprint.h).
#include "core/base/text.h"
#include "core/detect/base/beam_optics.h"
#include "core/detect/detector/effect_table.h"

namespace railcast {
namespace {

bool HasWidth(const DetectorSpec& spec) {
  return IsWide(spec.beam);
}

std::string FootprintText(const DetectorSpec& spec) {
  const auto& divergence_mrad = spec.beam.divergence_mrad;
  std::string of;
  for (const std::string& name : spec.beam.footprint_of) of += (of.empty() ? "" : ", ") + name;
  return "1/e^2 width " + NumberText(divergence_mrad[0]) + " x " + NumberText(divergence_mrad[1]) +
         " mrad, " + NumberText(spec.beam.footprint_rays) + " sub-rays" +
         (of.empty() ? "" : " where a beam may meet " + of);
}

std::string DenseFootprintText(const DetectorSpec& spec) {
  return NumberText(spec.beam.reference_rays) + " sub-rays a beam";
}

}  // namespace

std::vector<Effect> BeamEffects() {
  return {
      {.name = "footprint",
       .is_on = &EffectSet::footprint,
       .rungs = {Fidelity::kFootprint, Fidelity::kReference},
       .has_cause = HasWidth,
       .text = &FootprintText,
       .instructions = 27919.0},
      {.name = "thin_conductors",
       .is_on = &EffectSet::thin_conductors,
       .rungs = {Fidelity::kFootprint},
       .has_cause = HasWidth,
       .instructions = 10.0},
      // It extends the footprint, and it samples the triangles of wires, which thin_conductors
      // would count a second time.
      {.name = "dense_footprint",
       .is_on = &EffectSet::dense_footprint,
       .rungs = {Fidelity::kReference},
       .has_cause = HasWidth,
       .text = &DenseFootprintText,
       .needed = &EffectSet::footprint,
       .excluded = &EffectSet::thin_conductors},
      {.name = "sampled_waveform",
       .is_on = &EffectSet::sampled_waveform,
       .rungs = {Fidelity::kReference},
       .has_cause = HasWidth},
  };
}

}  // namespace railcast
