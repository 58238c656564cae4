#include "core/rail/objects/rail_vehicles.h"

#include "core/base/error.h"
#include "core/rail/base/model_parts.h"

namespace railcast {

RailVehicleMeasures MeasuresOf(const ObjectType& type) {
  Check(IsRailVehicle(type), "the type is a rail vehicle");
  const auto& [length_m, width_m, height_m] = type.model->size_m;
  return {.length_m = length_m,
          .pivot_distance_m = type.model->rail_vehicle->pivot_distance_m,
          .width_m = width_m,
          .height_m = height_m};
}

Model WholeOf(const Model& body, const Model& bogie, double pivot_distance_m) {
  Model whole = body;
  for (const double end : {-1.0, 1.0}) {
    const Transform whole_from_bogie =
        MakeTransform(Eigen::Matrix3d::Identity(), {end * pivot_distance_m / 2.0, 0, 0});
    for (const Part& part : bogie.parts) {
      MeshOf({part.material, part.label}, whole).Append(part.mesh, whole_from_bogie);
    }
  }
  return whole;
}

}  // namespace railcast
