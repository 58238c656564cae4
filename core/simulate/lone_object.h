#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <vector>

#include "core/trace/trace_scene.h"
#include "railcast/ray_caster.h"

namespace railcast {

/// An object that rays of a packet hit.
struct ObjectHits {
  std::size_t object{};   ///< Index into World::objects().
  std::uint32_t lanes{};  ///< Bit i: the packet's ray i hits it.
};

/// Objects of a frame in a scene of their own.
struct LoneObjects {
  std::shared_ptr<const TraceScene> scene;
  /// Indices into World::objects() of the first placements of the scene, each of which is a piece
  /// of its object. Further placements are something else.
  std::vector<std::size_t> objects;

  /// Appends the objects that rays of the packet beginning at `first` hit within range, whatever
  /// stands before them. Thread-safe.
  void AddHits(const RayTile& rays, std::size_t first, std::vector<ObjectHits>& hits) const;
};

}  // namespace railcast
