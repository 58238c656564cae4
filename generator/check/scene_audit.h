#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <set>
#include <span>
#include <string>
#include <vector>

#include "core/scene/object_contacts.h"
#include "core/simulate/window.h"
#include "railcast/lidar.h"
#include "railcast/material.h"
#include "railcast/scene.h"

namespace railcast {

/// A chunk of a window in full detail.
struct BuiltChunk {
  int index{};
  Chunk chunk;
};

/// Builds the chunks that a beam of `range_m` may reach at that time, several at once.
[[nodiscard]] std::vector<BuiltChunk> BuildChunksInReach(const World& world,
                                                         std::int64_t time_ns,
                                                         double range_m);

/// The content of the window at one moment.
struct SceneAudit {
  int home_chunk{};
  std::size_t num_chunks{};
  std::size_t ground_triangles{};   ///< In the chunks' own surfaces.
  std::size_t num_models{};         ///< Models, each stored once ...
  std::size_t model_triangles{};    ///< ... with this many triangles in total ...
  std::size_t num_placements{};     ///< ... and placed this many times ...
  std::size_t placed_triangles{};   ///< ... which gives this many triangles in the scene.
  std::size_t object_triangles{};   ///< In all objects of the world, in the window or not.
  std::set<std::string> materials;  ///< Materials used by any of these.
};

/// Counts the content of the chunks in reach at that time.
[[nodiscard]] SceneAudit AuditScene(const World& world,
                                    const MaterialLibrary& materials,
                                    std::int64_t time_ns,
                                    std::span<const BuiltChunk> chunks);

/// How coarse a window is for a sensor.
struct DetailAudit {
  std::size_t num_chunks{};          ///< All chunks; among them ...
  std::size_t num_coarser_chunks{};  ///< ... this many are traced in a coarser form.
  std::size_t full_surfaces{};       ///< Triangles of the chunks' own surfaces in full detail.
  std::size_t traced_surfaces{};     ///< The same as they are traced.
  struct Level {
    std::size_t num_placements{};
    double nearest_m{};  ///< Least distance of any of them.
  };
  std::size_t full_triangles{};    ///< All placements with coarser models, in full detail.
  std::size_t traced_triangles{};  ///< The same placements as they are traced.
  /// By the label of the models' first part, and by level from the finest.
  std::map<std::uint32_t, std::map<std::size_t, Level>> levels;
};

/// Looks which models and chunks the window at that time holds, of the chunks in reach. Nothing if
/// the rule is for full detail.
[[nodiscard]] DetailAudit AuditDetail(const World& world,
                                      std::int64_t time_ns,
                                      std::span<const BuiltChunk> chunks,
                                      const DetailRule& rule);

/// The first surface that a sensor sees in some direction.
struct SightedSurface {
  double range_m{};
  std::uint32_t label{};
  std::uint32_t instance{};
};

/// The surroundings of a sensor at time 0.
struct SensorSurroundings {
  Vector3 position_world;
  std::optional<SightedSurface> nearest;  ///< Among beams one degree apart in all directions.
  std::optional<SightedSurface> below;    ///< Within half a degree of straight down.
  std::optional<SightedSurface> above;    ///< Within half a degree of straight up.
  std::uint32_t inside{};  ///< The instance that all beams hit, or 0 if there is none.
};

/// Looks up to `range_m` in all directions from a position in the vehicle frame.
[[nodiscard]] SensorSurroundings LookAround(const std::shared_ptr<const World>& world,
                                            const MaterialLibrary& materials,
                                            const Vector3& position_vehicle,
                                            double range_m);

/// Whether the first surfaces that a frame's beams meet belong to the sensor's own vehicle.
struct OwnHits {
  std::size_t num_firings{};
  std::size_t num_on_vehicle{};
};

/// Counts those of frame 0, each beam as one ray; none if the vehicle has no body.
[[nodiscard]] OwnHits CountOwnHits(const std::shared_ptr<const World>& world,
                                   const MaterialLibrary& materials,
                                   const ScanPattern& pattern,
                                   const Transform& vehicle_from_sensor,
                                   double range_m);

/// Consecutive frames in which two objects touch or overlap.
struct ContactRun {
  std::uint32_t first_frame{};
  std::uint32_t last_frame{};
  std::uint32_t nearest_frame{};  ///< The first with the smallest gap or the greatest depth.
  ObjectContact nearest;          ///< In that frame.

  bool operator==(const ContactRun&) const = default;
};

/// Finds what touches or overlaps at the stamps of frames 0 to `last_frame`, by first frame and
/// then by object.
[[nodiscard]] std::vector<ContactRun> FindContactRuns(const World& world,
                                                      const ScanPattern& pattern,
                                                      std::uint32_t last_frame);

}  // namespace railcast
