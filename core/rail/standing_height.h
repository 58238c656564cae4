#pragma once

#include <Eigen/Geometry>

#include "core/rail/chunk_context.h"

namespace railcast {

/// Where something is put on the line.
struct Footprint {
  double s_m{};                ///< Chainage of its middle.
  double d_m{};                ///< Of its middle, left of the alignment's axis.
  double heading_rad{};        ///< Turned left against the direction of the chainage.
  Eigen::AlignedBox2d area_m;  ///< About its middle, x forward, y left.
};

/// How high the foot of something stands in the world: on the ground or the ballast, whichever is
/// higher, at the lowest of its middle and corners. So it may sink a little into a slope, but
/// nothing hangs in the air. Grains of ballast are left out of account.
[[nodiscard]] double StandingHeight_m(const ChunkContext& context, const Footprint& footprint);

}  // namespace railcast
