#include "core/simulate/lone_object.h"

#include <algorithm>

namespace railcast {
namespace {

// Returns whether any ray of the tile may pass through the object's sphere. The margin of half a
// metre covers float32 rounding in the squares of 300 m and more.
bool MayMeet(const RayTile& rays, const LoneObject& lone) {
  const float reach_m = lone.radius_m + 0.5F;
  for (std::size_t i = 0; i < rays.num_rays; ++i) {
    const Eigen::Vector3f to_center =
        lone.center_window_m -
        Eigen::Vector3f(rays.origin_x[i], rays.origin_y[i], rays.origin_z[i]);
    const float along_m = to_center.dot(
        Eigen::Vector3f(rays.direction_x[i], rays.direction_y[i], rays.direction_z[i]));
    if (along_m >= -reach_m && to_center.squaredNorm() - along_m * along_m <= reach_m * reach_m) {
      return true;
    }
  }
  return false;
}

}  // namespace

std::uint32_t LoneObject::CountHits(RayTile& rays,
                                    std::size_t num_firings,
                                    float range_max_m) const {
  if (!MayMeet(rays, *this)) return 0;
  std::fill_n(rays.range_m, kTileSize, range_max_m);
  scene->CastRanges(rays);
  return static_cast<std::uint32_t>(
      std::count_if(rays.range_m, rays.range_m + num_firings,
                    [&](float range_m) { return range_m < range_max_m; }));
}

}  // namespace railcast
