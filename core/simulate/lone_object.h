#pragma once

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <vector>

#include "core/trace/trace_scene.h"
#include "railcast/ray_caster.h"

namespace railcast {

/// Objects of a frame in a scene of their own.
struct LoneObjects {
  std::shared_ptr<const TraceScene> scene;
  /// Indices into World::objects() of the first placements of the scene, each of which is a piece
  /// of its object. Further placements are something else.
  std::vector<std::size_t> objects;

  /// For every object, adds how many of the first `num_firings` rays hit it within range, whatever
  /// stands before it. Thread-safe.
  /// @param counts By index into World::objects().
  void CountHits(const RayTile& rays,
                 std::size_t num_firings,
                 std::vector<std::atomic<std::uint32_t>>& counts) const;
};

}  // namespace railcast
