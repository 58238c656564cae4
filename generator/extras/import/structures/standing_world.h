#pragma once

#include <filesystem>
#include <optional>
#include <string>

#include "generator/extras/import/network/line_world.h"
#include "railcast/alignment.h"

namespace railcast {

/// Leaves out what `railcast-generate check` would have something against, and says so: structures
/// that break a rule of worlds (CheckStructures), and those that stand in the clear space of a
/// track (FindStructuresInGauge). What runs along a track is cut there instead, and portals that
/// stand in one are left out alone.
/// @param alignment Complete, with heights and cants.
void ClearStructures(const AlignmentSpec& alignment, LineWorld& world);

/// Holds a world against the rules that `railcast-generate check` has for it (DraftWorld), and
/// leaves out the tracks and structures that break one, with all that depends on them, until none
/// does.
/// @param elevation Its elevation model; absent if it has none.
/// @returns What is wrong with the line itself, so that no world stands; absent if this one does.
[[nodiscard]] std::optional<std::string> MakeStand(
    const AlignmentSpec& alignment,
    const std::optional<std::filesystem::path>& elevation,
    LineWorld& world);

}  // namespace railcast
