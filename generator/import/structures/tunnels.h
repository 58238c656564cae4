#pragma once

#include "generator/import/map/rail_map.h"
#include "generator/import/network/line_world.h"

namespace railcast {

/// Adds tunnels where the ways of a world's tracks have them.
///
/// At every metre, tracks of which one runs within kSharedTunnel_m of the next make a row, and a
/// row of which a track is in a tunnel on the map shares one. A tunnel goes on along the line as
/// long as no track leaves its row for another one, and is divided where it would else be wider
/// than it needs for more than 50 m. The parts follow each other without a gap.
///
/// All tracks of a world have the height of their line. Where the line's own track is in a tunnel,
/// its row is in it with all its tracks, whatever the map says of the others. Where it is outside,
/// no row with it has a tunnel, and none of which more tracks are outside on the map than in one.
void AddTunnels(const RailMap& map, LineWorld& world);

}  // namespace railcast
