#include "core/rail/objects/road_vehicle_parts.h"

#include <cmath>
#include <limits>
#include <vector>

#include "core/rail/base/model_parts.h"
#include "core/rail/objects/lofted_body.h"
#include "core/rail/objects/wagon_parts.h"

namespace railcast {

void AddRoadWheel(const WheelMeasures& measures,
                  const Vector3& hub_m,
                  const RoadVehicleSurfaces& surfaces,
                  Model& vehicle) {
  const double out = hub_m.y() < 0.0 ? -1.0 : 1.0;
  const double half_m = 0.5 * measures.width_m;
  const double rim_m = measures.rim_radius_m;
  const double wall_m = measures.radius_m - rim_m;
  const std::vector<Eigen::Vector2d> tyre = {
      {-0.80 * half_m, rim_m},
      {-half_m, rim_m + 0.55 * wall_m},
      {-0.78 * half_m, measures.radius_m},
      {0.78 * half_m, measures.radius_m},
      {half_m, rim_m + 0.55 * wall_m},
      {0.80 * half_m, rim_m},
  };
  const std::vector<Eigen::Vector2d> rim = {
      {-0.7 * out * half_m, 0.0},         {-0.7 * out * half_m, rim_m},
      {0.82 * out * half_m, rim_m},       {0.35 * out * half_m, 0.82 * rim_m},
      {0.55 * out * half_m, 0.3 * rim_m}, {0.62 * out * half_m, 0.0},
  };
  const Transform place = MakeTransform(Eigen::Matrix3d::Identity(), hub_m);
  MeshOf(surfaces.tyre, vehicle).Append(MakeRevolvedBody(tyre, measures.num_sides), place);
  MeshOf(surfaces.metal, vehicle).Append(MakeRevolvedBody(rim, measures.num_sides), place);
}

void AddNumberPlate(double end,
                    const Vector3& face_m,
                    const RoadVehicleSurfaces& surfaces,
                    Model& vehicle) {
  const Vector3 half_m(0.0025, 0.26, 0.055);
  const Vector3 middle_m = face_m - Vector3(end * half_m.x(), 0, 0);
  MeshOf(surfaces.reflector, vehicle).Append(MakeBlock(middle_m - half_m, middle_m + half_m));
}

double ArchHeight_m(double x_m, double axle_x_m, double axle_z_m, double radius_m) {
  const double ahead_m = x_m - axle_x_m;
  if (std::abs(ahead_m) >= radius_m) return -std::numeric_limits<double>::infinity();
  return axle_z_m + std::sqrt(radius_m * radius_m - ahead_m * ahead_m);
}

}  // namespace railcast
