#pragma once

#include <optional>

#include "generator/extras/import/network/track_network.h"
#include "generator/extras/import/network/track_runs.h"
#include "generator/extras/import/network/turnout_search.h"

namespace railcast {

/// The run as a track parallel to the line but for S-curves, with as many turnouts at its ends as
/// possible; absent if it is none (LevelsOf), or if it would not be where the map has it.
[[nodiscard]] std::optional<TrackDraft> LevelTrackOf(const TrackNetwork& network,
                                                     const TrackRun& run,
                                                     const std::optional<Meeting>& begin,
                                                     const std::optional<Meeting>& end);

/// Whether a track is where the run's points are: nearly all of them within 1 m, and none farther
/// off than 2 m.
[[nodiscard]] bool Follows(const TrackDraft& draft, const TrackRun& run);

}  // namespace railcast
