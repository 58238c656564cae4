#include "core/rail/infrastructure_models.h"

#include "core/rail/catenary/catenary_models.h"
#include "core/rail/track/sleeper_models.h"

namespace railcast {

InfrastructureModels MakeInfrastructureModels(const WorldSpec& spec, const RailSurfaces& surfaces) {
  const auto shared = [](Model model) { return std::make_shared<const Model>(std::move(model)); };
  InfrastructureModels models;
  models.concrete_sleeper = shared(MakeConcreteSleeper(surfaces));
  models.wood_sleeper = shared(MakeWoodSleeper(surfaces));
  models.mast = shared(MakeMast(spec.catenary, surfaces));
  for (std::size_t track = 0; track < spec.tracks.size(); ++track) {
    CantileverPair& pair = models.cantilevers.emplace_back();
    if (!spec.catenary.enabled || !spec.tracks[track].electrified) continue;
    const MastSite site = MastSiteOf(spec, track);
    const double stagger_m = spec.catenary.stagger_m;
    pair.wire_left = shared(MakeCantilever(spec.catenary, site, stagger_m, surfaces));
    pair.wire_right = shared(MakeCantilever(spec.catenary, site, -stagger_m, surfaces));
  }
  return models;
}

}  // namespace railcast
