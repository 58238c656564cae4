#pragma once

#include <cstddef>
#include <cstdint>
#include <set>
#include <string>
#include <vector>

#include "core/scene/material.h"
#include "core/scene/world.h"

namespace railcast {

/// What stands in the window of one moment.
struct SceneAudit {
  int home_chunk{};
  std::size_t num_chunks{};
  std::size_t ground_triangles{};   ///< Of the chunks' own surfaces.
  std::size_t num_models{};         ///< Stored once each ...
  std::size_t model_triangles{};    ///< ... with so many triangles together ...
  std::size_t num_placements{};     ///< ... and placed so many times ...
  std::size_t placed_triangles{};   ///< ... which makes so many triangles in the scene.
  std::size_t object_triangles{};   ///< Of all objects of the world, in the window or not.
  std::set<std::string> materials;  ///< Used by any of them.
};

/// Builds the chunks that a beam of `range_m` may reach at that time and counts them.
[[nodiscard]] SceneAudit AuditScene(const World& world,
                                    const MaterialLibrary& materials,
                                    std::int64_t time_ns,
                                    double range_m);

}  // namespace railcast
