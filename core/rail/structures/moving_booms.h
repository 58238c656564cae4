#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "core/rail/chunk/chunk_context.h"
#include "railcast/lineside.h"
#include "railcast/scene.h"
#include "railcast/transform.h"

namespace railcast {

/// The boom of a half barrier that moves while the scenario runs.
struct MovingBoom {
  std::string name;
  std::shared_ptr<const Model> model;  ///< Closed, about its axis (MakeBoom).
  Transform world_from_barrier;
  std::vector<TimedValue> angles_deg;  ///< Not empty, in rising time.

  [[nodiscard]] double Angle_rad(std::int64_t time_ns) const;
  [[nodiscard]] Transform WorldFromBoom(std::int64_t time_ns) const;
};

/// Name of the boom towards which one drives from the left (+1) or right (-1) side of the track.
[[nodiscard]] std::string BoomName(const std::string& crossing, double side);

/// The booms of a crossing, first that on the right of the track; none if they do not move.
/// @param context Of the chunk that holds the crossing.
[[nodiscard]] std::vector<MovingBoom> MovingBoomsOf(const ChunkContext& context,
                                                    const LevelCrossingSpec& crossing);

}  // namespace railcast
