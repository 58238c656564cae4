#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <utility>
#include <vector>

#include "core/trace/trace_scene.h"
#include "railcast/ray_caster.h"

namespace railcast {

/// One ray as the tracer sees it: float32, window frame.
struct Ray {
  Eigen::Vector3f origin_m;
  Eigen::Vector3f direction;  ///< Unit length.
};

struct RayHit {
  float range_m{};
  std::uint32_t surface{};  ///< 0: nothing was hit.

  bool operator==(const RayHit&) const = default;
};

/// Sets one ray of a tile, which reaches `range_max_m` and has hit nothing yet.
inline void SetRay(RayTile& tile, std::size_t i, const Ray& ray, float range_max_m) {
  tile.origin_x[i] = ray.origin_m.x();
  tile.origin_y[i] = ray.origin_m.y();
  tile.origin_z[i] = ray.origin_m.z();
  tile.direction_x[i] = ray.direction.x();
  tile.direction_y[i] = ray.direction.y();
  tile.direction_z[i] = ray.direction.z();
  tile.shutter[i] = 0.0F;
  tile.range_m[i] = range_max_m;
  tile.surface[i] = 0;
}

/// Casts rays in packets of 16 in the order given; `hits` receives one answer per ray.
inline void CastRays(const RayCaster& caster,
                     std::span<const Ray> rays,
                     float range_max_m,
                     std::span<RayHit> hits) {
  auto tile = std::make_unique<RayTile>();
  for (std::size_t begin = 0; begin < rays.size(); begin += kTileSize) {
    const std::size_t count = std::min(kTileSize, rays.size() - begin);
    tile->num_rays = (count + 15) / 16 * 16;
    for (std::size_t i = 0; i < tile->num_rays; ++i) {
      SetRay(*tile, i, rays[begin + std::min(i, count - 1)], range_max_m);
    }
    caster.Cast(*tile);
    for (std::size_t i = 0; i < count; ++i) {
      hits[begin + i] = {tile->range_m[i], tile->surface[i]};
    }
  }
}

[[nodiscard]] inline std::vector<RayHit> CastRays(const RayCaster& caster,
                                                  std::span<const Ray> rays,
                                                  float range_max_m) {
  std::vector<RayHit> hits(rays.size());
  CastRays(caster, rays, range_max_m, hits);
  return hits;
}

/// Returns a ray from one point through another.
[[nodiscard]] inline Ray RayThrough(const Eigen::Vector3d& origin_m,
                                    const Eigen::Vector3d& target_m) {
  return {origin_m.cast<float>(), (target_m - origin_m).normalized().cast<float>()};
}

/// Builds a scene of one model at `window_from_model`. Its part i is surface i + 1.
[[nodiscard]] inline std::unique_ptr<const TraceScene> SceneOf(
    const TraceDevice& device,
    const Model& model,
    const Eigen::Affine3d& window_from_model = Eigen::Affine3d::Identity()) {
  TracePlacement placement{std::make_shared<TraceModel>(device, model), {window_from_model}, 1};
  return std::make_unique<TraceScene>(device, std::vector{std::move(placement)});
}

}  // namespace railcast
