#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "core/rail/base/world_faults.h"
#include "core/rail/motion/path_way.h"
#include "core/rail/motion/track_path.h"
#include "railcast/alignment.h"
#include "railcast/world_spec.h"

namespace railcast {

/// What paths are made on.
struct PathGround {
  const Alignment& alignment;
  double half_width_m{};     ///< Of the ground on either side of the alignment.
  const TrackPath& vehicle;  ///< The sensor's vehicle.
  std::int64_t begin_ns{};   ///< When the paths' own time is 0.
};

/// The object that a path is for.
struct PathSubject {
  double length_m{};           ///< Over some of which it turns at corners.
  const std::string& pointer;  ///< With which faults begin.
};

/// Makes the way of an object whose motion has a path, or nothing if there is a fault.
/// @param place The object on its track, standing.
[[nodiscard]] std::optional<PathWay> DraftPathWay(const PathGround& ground,
                                                  const ObjectSpec& object,
                                                  const TrackPath& place,
                                                  const PathSubject& subject,
                                                  WorldFaults& faults);

}  // namespace railcast
