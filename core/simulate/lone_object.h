#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>

#include "core/trace/trace_scene.h"
#include "railcast/ray_caster.h"
#include "railcast/transform.h"

namespace railcast {

/// A single object at its place in a frame, without anything else.
struct LoneObject {
  std::size_t object{};
  std::unique_ptr<const TraceScene> scene;
  /// Centre of a sphere that contains the object throughout the frame.
  Eigen::Vector3f center_window_m;
  float radius_m{};

  /// Returns how many of the first `num_firings` rays hit the object within range. Overwrites the
  /// ranges of the rays.
  [[nodiscard]] std::uint32_t CountHits(RayTile& rays,
                                        std::size_t num_firings,
                                        float range_max_m) const;
};

}  // namespace railcast
