#pragma once

#include "core/rail/objects/object_surfaces.h"
#include "railcast/scene.h"
#include "railcast/transform.h"

namespace railcast {

/// Elements from which road vehicles are composed. Frame: x forward, y left, z up; metres.

struct WheelMeasures {
  double radius_m{};  ///< Of the tyre.
  double width_m{};   ///< Of the tyre.
  double rim_radius_m{};
  int num_sides = 24;  ///< A multiple of four, so that a corner touches the road.
};

/// Adds a wheel about `hub_m`, the middle of its axis. Its dished face looks away from the
/// vehicle's middle plane.
void AddRoadWheel(const WheelMeasures& measures,
                  const Vector3& hub_m,
                  const RoadVehicleSurfaces& surfaces,
                  Model& vehicle);

/// Adds a number plate of 520 x 110 mm, 5 mm thick, whose face looks forward at `face_m` if `end`
/// is 1, and backward if it is -1.
void AddNumberPlate(double end,
                    const Vector3& face_m,
                    const RoadVehicleSurfaces& surfaces,
                    Model& vehicle);

/// The height of a wheel arch above the road at `x_m`, and -infinity beyond it.
[[nodiscard]] double ArchHeight_m(double x_m, double axle_x_m, double axle_z_m, double radius_m);

}  // namespace railcast
