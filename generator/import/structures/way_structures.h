#pragma once

#include "generator/import/map/rail_map.h"
#include "generator/import/network/line_world.h"

namespace railcast {

/// Adds tunnels, bridges, slab track and conductor rails where the ways of a world's tracks have
/// them.
///
/// Tracks of which one runs within 5.5 m of the next share a tunnel, and within 7 m a bridge: it
/// follows the main track if that is tagged, else that with the longest tagged stretch, and the
/// stretches of the others that it has room for need none of their own. No tunnel is where a track
/// that has none on the map would run in it; a bridge carries such tracks, too.
void AddWayStructures(const RailMap& map, LineWorld& world);

}  // namespace railcast
