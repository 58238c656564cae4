#pragma once

#include <optional>
#include <span>
#include <vector>

#include "core/rail/base/chainage_range.h"
#include "generator/import/lines/line_stretches.h"
#include "generator/import/map/rail_map.h"
#include "generator/import/network/track_runs.h"

namespace railcast {

/// The part of a run between two chainages of it; absent if it is shorter than 30 m.
[[nodiscard]] std::optional<TrackRun> PartOfRun(const TrackRun& run,
                                                double from_s_m,
                                                double to_s_m);

/// The tunnels of a run in which it is below its line: on the axis of the line's own track, which
/// is in no tunnel there. A tunnel that begins or ends on the axis is none of them.
/// @param line_ways Of the line's own track.
[[nodiscard]] std::vector<ChainageRange> TunnelsBelowLine(const RailMap& map,
                                                          std::span<const LineStretch> line_ways,
                                                          const TrackRun& run);

/// What is left of a run without some stretches of it, as far as it is 30 m long. Without any
/// stretches this is the run itself.
/// @param stretches In order of chainage.
[[nodiscard]] std::vector<TrackRun> PartsBetween(const TrackRun& run,
                                                 std::span<const ChainageRange> stretches);

}  // namespace railcast
