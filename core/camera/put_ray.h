#pragma once

#include <Eigen/Core>
#include <cstddef>

#include "railcast/ray_caster.h"

namespace railcast {

/// Puts a ray that has met nothing yet into a tile, at the frame's stamp.
inline void PutRay(const Eigen::Vector3f& origin,
                   const Eigen::Vector3f& direction,
                   float range_m,
                   std::size_t i,
                   RayTile& rays) {
  rays.origin_x[i] = origin.x();
  rays.origin_y[i] = origin.y();
  rays.origin_z[i] = origin.z();
  rays.direction_x[i] = direction.x();
  rays.direction_y[i] = direction.y();
  rays.direction_z[i] = direction.z();
  rays.shutter[i] = 0.0F;
  rays.range_m[i] = range_m;
  rays.surface[i] = 0;
  rays.normal_x[i] = 0.0F;
  rays.normal_y[i] = 0.0F;
  rays.normal_z[i] = 0.0F;
}

}  // namespace railcast
