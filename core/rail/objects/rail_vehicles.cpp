#include "core/rail/objects/rail_vehicles.h"

#include <algorithm>
#include <array>

#include "core/base/error.h"
#include "core/rail/base/model_parts.h"
#include "core/rail/objects/rolling_stock.h"
#include "core/rail/objects/wagon_parts.h"

namespace railcast {
namespace {

struct RailVehicleRow {
  ObjectType type{};
  RailVehicleMeasures measures;
  RailVehicleModel (*make)(const RailSurfaces&);
};

constexpr auto kRailVehicleRows = std::to_array<RailVehicleRow>({
    {ObjectType::kOpenWagon, kOpenWagonMeasures, MakeOpenWagon},
    {ObjectType::kFlatWagon, kFlatWagonMeasures, MakeFlatWagon},
    {ObjectType::kTankWagon, kTankWagonMeasures, MakeTankWagon},
    {ObjectType::kContainerWagon, kContainerWagonMeasures, MakeContainerWagon},
    {ObjectType::kCoveredWagon, kCoveredWagonMeasures, MakeCoveredWagon},
    {ObjectType::kHopperWagon, kHopperWagonMeasures, MakeHopperWagon},
    {ObjectType::kShuntingLocomotive, kShuntingLocomotiveMeasures, MakeShuntingLocomotive},
    {ObjectType::kElectricLocomotive, kElectricLocomotiveMeasures, MakeElectricLocomotive},
    {ObjectType::kMultipleUnit, kMultipleUnitMeasures, MakeMultipleUnit},
    {ObjectType::kCoach, kCoachMeasures, MakeCoach},
    {ObjectType::kMetroCar, kMetroCarMeasures, MakeMetroCar},
});

const RailVehicleRow& RowOf(ObjectType type) {
  const auto* const row = std::find_if(kRailVehicleRows.begin(), kRailVehicleRows.end(),
                                       [&](const RailVehicleRow& r) { return r.type == type; });
  Check(row != kRailVehicleRows.end(), "the type is a rail vehicle");
  return *row;
}

bool HasOwnSurfaces(ObjectType type) {
  return IsRailVehicle(type) && type != ObjectType::kOpenWagon && type != ObjectType::kFlatWagon &&
         type != ObjectType::kTankWagon;
}

}  // namespace

bool HasVehicleSurfaces(const WorldSpec& world, const VehicleSpec& vehicle) {
  const auto has_own = [](const auto& one) { return HasOwnSurfaces(one.type); };
  return std::ranges::any_of(world.objects, has_own) ||
         std::ranges::any_of(vehicle.consist, has_own) ||
         std::ranges::any_of(world.trains, [&](const TrainSpec& train) {
           return std::ranges::any_of(train.vehicles, has_own);
         });
}

const RailVehicleMeasures& MeasuresOf(ObjectType type) {
  return RowOf(type).measures;
}

RailVehicleModel MakeRailVehicle(ObjectType type, const RailSurfaces& surfaces) {
  return RowOf(type).make(surfaces);
}

Model WholeOf(const RailVehicleModel& vehicle, double pivot_distance_m) {
  Model whole = vehicle.body;
  for (const double end : kBothSides) {
    const Transform whole_from_bogie =
        MakeTransform(Eigen::Matrix3d::Identity(), {end * pivot_distance_m / 2.0, 0, 0});
    for (const Part& part : vehicle.bogie.parts) {
      MeshOf({part.material, part.label}, whole).Append(part.mesh, whole_from_bogie);
    }
  }
  return whole;
}

}  // namespace railcast
