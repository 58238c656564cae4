#pragma once

#include <string>

#include "core/rail/base/world_faults.h"
#include "core/rail/network/network.h"
#include "railcast/alignment.h"
#include "railcast/world_spec.h"

namespace railcast {

/// The line and the tracks beside which things of the map are placed.
struct MappedTracks {
  const WorldSpec& world;
  const NetworkDraft& network;
  const Alignment* alignment{};  ///< Null if it is not known as a whole.
};

/// Turns places on the map (x_m and y_m, or longitude_deg and latitude_deg) into those that the
/// world is made of: the object's own into s_m and d_m beside its track or route, those of its path
/// into x_m and y_m of the world.
///
/// The object's place must lie on the ground, nearer to one place of the line than to any other,
/// and beside the track. A rail vehicle that has not left the track stands on its axis, from which
/// the place may be kOffTrack_m away. Faults begin with `pointer`; what cannot be placed is
/// unknown.
void PlaceFromMap(const MappedTracks& tracks,
                  const std::string& pointer,
                  ObjectSpec& object,
                  WorldFaults& faults);

/// Maps show tracks to this, and tracks are 3 m apart at least.
inline constexpr double kOffTrack_m = 1.5;

}  // namespace railcast
