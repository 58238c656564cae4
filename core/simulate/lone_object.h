#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>

#include "core/base/transform.h"
#include "core/trace/ray_tile.h"
#include "core/trace/trace_scene.h"

namespace railcast {

/// An object of a world where it is in a frame, and nothing else.
struct LoneObject {
  std::size_t object{};
  std::unique_ptr<const TraceScene> scene;
  Eigen::Vector3f center_window_m;  ///< Of a sphere that holds it throughout the frame.
  float radius_m{};

  /// How many of the first `num_firings` rays hit it within range. Overwrites the rays' ranges.
  [[nodiscard]] std::uint32_t CountHits(RayTile& rays,
                                        std::size_t num_firings,
                                        float range_max_m) const;
};

}  // namespace railcast
