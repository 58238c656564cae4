#include "core/motion/sky.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numbers>

#include "core/camera/wires_in_pixels.h"
#include "railcast/ray_caster.h"

namespace railcast {
namespace {

/// The directions are those of a Fibonacci lattice: equal steps in height, and a turn by the golden
/// angle from one to the next. They keep to the world's axes.
Vector3 SkyDirection(std::size_t ray, double elevation_mask_rad) {
  const double golden_angle_rad = std::numbers::pi * (3.0 - std::sqrt(5.0));
  const double share = (static_cast<double>(ray) + 0.5) / static_cast<double>(kTileSize);
  const double up = std::lerp(std::sin(elevation_mask_rad), 1.0, share);
  const double aside = std::sqrt(std::max(0.0, 1.0 - up * up));
  const double turn_rad = golden_angle_rad * static_cast<double>(ray);
  return {aside * std::cos(turn_rad), aside * std::sin(turn_rad), up};
}

/// Puts the rays behind surfaces of the vehicle itself.
/// @return Whether there was any.
bool PassThroughVehicle(const SceneOfFrame& scene, double range_m, RayTile& rays) {
  constexpr float kBehind_m = 1e-3F;
  bool was_any = false;
  for (std::size_t i = 0; i < rays.num_rays; ++i) {
    const bool is_ego = scene.surfaces[rays.surface[i]].is_ego;
    const float moved_m = is_ego ? rays.range_m[i] + kBehind_m : 0.0F;
    rays.origin_x[i] += moved_m * rays.direction_x[i];
    rays.origin_y[i] += moved_m * rays.direction_y[i];
    rays.origin_z[i] += moved_m * rays.direction_z[i];
    if (!is_ego) continue;
    was_any = true;
    rays.range_m[i] = static_cast<float>(range_m);
    rays.surface[i] = 0;
  }
  return was_any;
}

}  // namespace

double FreeSkyShare(const SceneOfFrame& scene,
                    const Vector3& place_world_m,
                    double elevation_mask_rad,
                    double range_m) {
  RayTile rays{};
  rays.num_rays = kTileSize;
  rays.mask = kAllButWires;
  const Vector3 place_m = scene.window_from_world * place_world_m;
  for (std::size_t i = 0; i < kTileSize; ++i) {
    const Vector3 direction =
        scene.window_from_world.linear() * SkyDirection(i, elevation_mask_rad);
    PutRay(place_m.cast<float>(), direction.cast<float>(), static_cast<float>(range_m), i, rays);
  }
  // A ray may meet several surfaces of the vehicle: the walls of a box in which the antenna is.
  constexpr int kMostSurfaces = 16;
  for (int pass = 0; pass < kMostSurfaces; ++pass) {
    scene.caster.Cast(rays);
    if (!PassThroughVehicle(scene, range_m, rays)) break;
  }
  const auto num_free = std::count(rays.surface, rays.surface + kTileSize, 0U);
  return static_cast<double>(num_free) / static_cast<double>(kTileSize);
}

}  // namespace railcast
