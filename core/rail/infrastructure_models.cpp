#include "core/rail/infrastructure_models.h"

#include "core/rail/catenary/catenary_models.h"

namespace railcast {

InfrastructureModels MakeInfrastructureModels(const WorldSpec& spec, const RailSurfaces& surfaces) {
  const auto shared = [](Model model) { return std::make_shared<const Model>(std::move(model)); };
  InfrastructureModels models;
  models.concrete_sleeper = shared(MakeConcreteSleeper(surfaces));
  models.wood_sleeper = shared(MakeWoodSleeper(surfaces));
  models.mast = shared(MakeMast(spec.catenary, surfaces));
  return models;
}

}  // namespace railcast
