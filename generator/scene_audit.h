#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
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

/// A surface that a sensor sees first in some direction.
struct Sighting {
  double range_m{};
  std::uint32_t label{};
  std::uint32_t instance{};
};

/// What is around a sensor at time 0.
struct Surroundings {
  Vector3 position_world;
  std::optional<Sighting> nearest;  ///< Of beams a degree apart in all directions.
  std::optional<Sighting> below;    ///< Within half a degree of straight down.
  std::optional<Sighting> above;    ///< Within half a degree of straight up.
  std::uint32_t inside{};           ///< The instance that all beams hit, if there is one such.
};

/// Looks from a place in the vehicle frame to `range_m` in all directions.
[[nodiscard]] Surroundings LookAround(const std::shared_ptr<const World>& world,
                                      const MaterialLibrary& materials,
                                      const Vector3& position_vehicle,
                                      double range_m);

}  // namespace railcast
