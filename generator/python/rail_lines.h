#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "railcast/rail_world.h"
#include "railcast/transform.h"

namespace railcast {

/// The running rails of a stretch of track: the middles of their heads at top of rail, every metre
/// of chainage, in the order in which the vehicle comes to them.
struct RailLines {
  std::string track;
  bool is_ego{};                ///< Whether the vehicle is on this way, over its turnouts.
  std::vector<Vector3> left_m;  ///< Left and right as the vehicle faces.
  std::vector<Vector3> right_m;
};

/// How much of the chainage before and behind the vehicle's origin is of interest.
struct RailReach {
  double behind_m{};
  double ahead_m{};
};

/// Returns the rails of all tracks about the vehicle at a time, in the axes of `to_from_world`. The
/// first is the vehicle's own way; it is absent where that does not extend. What other tracks have
/// in common with it is left out of them.
[[nodiscard]] std::vector<RailLines> RailLinesAbout(const RailWorld& world,
                                                    const AlignmentSpec& line,
                                                    std::int64_t time_ns,
                                                    const RailReach& reach,
                                                    const Transform& to_from_world);

}  // namespace railcast
