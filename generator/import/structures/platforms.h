#pragma once

#include "generator/import/lines/line_places.h"
#include "generator/import/map/rail_map.h"
#include "generator/import/network/line_world.h"

namespace railcast {

/// Adds the edges of a platform, a line or an outline on the map, to the world.
///
/// At every whole metre of chainage the platform belongs to the next track on either side, if its
/// nearer side is 1 to 4.5 m from that track's axis. Each such stretch of at least 5 m becomes a
/// platform at the usual distance from the axis: as wide as the outline or, between two tracks,
/// half as wide as what lies between the edges. Where the width changes by more than 0.5 m, another
/// one begins, but not within 20 m.
void AddPlatform(const MapThing& thing, const LinePlaces& places, LineWorld& world);

}  // namespace railcast
