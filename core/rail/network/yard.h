#pragma once

#include <string>
#include <vector>

#include "core/base/error.h"
#include "railcast/world_spec.h"

namespace railcast {

/// The tracks of all yards of a world.
///
/// A yard's lead, NAME_lead, leaves its turnout and runs straight on at the turnout's angle. In it
/// lie the turnouts of the tracks NAME_1, NAME_2 and so on, the first of which is nearest to the
/// track that the yard branches off. They lead back, so that all tracks are parallel, `spacing_m`
/// apart. Behind the last turnout the lead turns back in an arc of the turnout's radius and is the
/// last of the yard's tracks. Each track ends `usable_length_m` behind its fouling point, where
/// its axis is kFoulingDistance_m from that of its neighbour.
[[nodiscard]] std::vector<TrackSpec> TracksOfYards(const WorldSpec& world);

/// The world with the tracks of its yards behind its own, and without yards.
[[nodiscard]] WorldSpec WithTracksOfYards(const WorldSpec& world);

/// Faults of yards themselves: names, missing sides, and spacings in which the turnouts of a ladder
/// have no room. Pointers begin with "/world/yards/".
void CheckYards(const WorldSpec& world, ErrorList& errors);

/// A fault of a track of WithTracksOfYards() as one of its yard; others are unchanged.
[[nodiscard]] Fault FaultOfYard(const WorldSpec& world, const Fault& fault);

}  // namespace railcast
