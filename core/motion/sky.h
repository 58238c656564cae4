#pragma once

#include <cstdint>

#include "railcast/simulator.h"
#include "railcast/transform.h"

namespace railcast {

/// How far away things hide the sky. Farther ones stand low, or are as high as hills.
inline constexpr double kSkyReach_m = 100.0;

/// The share of the sky above an elevation mask that nothing hides, by kTileSize rays that are
/// spread evenly over it in solid angle. Wires hide nothing, nor does the vehicle itself.
/// What moves is where it is at the frame's stamp.
[[nodiscard]] double FreeSkyShare(const SceneOfFrame& scene,
                                  const Vector3& place_world_m,
                                  double elevation_mask_rad,
                                  double range_m);

}  // namespace railcast
