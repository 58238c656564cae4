#include "core/rail/track/infrastructure_models.h"

#include "core/rail/base/rail_section.h"
#include "core/rail/catenary/catenary_models.h"
#include "core/rail/track/cross_section.h"
#include "core/rail/track/turnout_structure.h"

namespace railcast {

InfrastructureModels MakeInfrastructureModels(const WorldSpec& spec, const RailSurfaces& surfaces) {
  const auto shared = [](Model model) { return std::make_shared<const Model>(std::move(model)); };
  InfrastructureModels models;
  const double shift_m = RailShift_m(spec.alignment);
  models.concrete_sleeper = shared(MakeConcreteSleeper(surfaces, shift_m));
  models.wood_sleeper = shared(MakeWoodSleeper(surfaces, shift_m));
  for (int i = 0; kShortestBearer_m + kBearerStep_m * i < kLongestBearer_m; ++i) {
    const double length_m = kShortestBearer_m + kBearerStep_m * i;
    models.concrete_bearers.push_back(
        shared(MakeBearer(SleeperType::kConcrete, length_m, surfaces)));
    models.wood_bearers.push_back(shared(MakeBearer(SleeperType::kWood, length_m, surfaces)));
  }
  models.concrete_plate = shared(MakeRailPlate(SleeperType::kConcrete, surfaces));
  models.wood_plate = shared(MakeRailPlate(SleeperType::kWood, surfaces));
  models.point_machine = shared(MakePointMachine(surfaces));
  models.mast = shared(MakeMast(spec.catenary, surfaces));
  return models;
}

}  // namespace railcast
