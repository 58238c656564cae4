#include "core/rail/objects/road_vehicles.h"

#include "core/base/error.h"

namespace railcast {

Model MakeRoadVehicle(ObjectType type, const RoadVehicleSurfaces& surfaces) {
  Check(IsRoadVehicle(type), "a road vehicle has a model");
  if (type == ObjectType::kCar) return MakeCar(surfaces);
  if (type == ObjectType::kLorry) return MakeLorry(surfaces);
  if (type == ObjectType::kBus) return MakeBus(surfaces);
  if (type == ObjectType::kTractor) return MakeTractor(surfaces);
  if (type == ObjectType::kBicycle) return MakeBicycle(surfaces);
  return MakeMotorcycle(surfaces);
}

}  // namespace railcast
