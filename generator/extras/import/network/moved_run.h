#pragma once

#include <optional>

#include "generator/extras/import/network/track_network.h"
#include "generator/extras/import/network/track_runs.h"
#include "generator/extras/import/network/turnout_search.h"

namespace railcast {

/// The distance between axes to which tracks are moved that the map has nearer to each other: half
/// the vehicle's outline on either one, 3.15 m, twice 15 mm by which a curve of 250 m radius widens
/// it (CurveWidening_m), and 0.07 m for the difference between a fit and its points.
inline constexpr double kMovedApart_m = 3.25;

/// So much farther away than that are points of a track if its fit would else round a corner
/// between them on the wrong side.
inline constexpr double kMostRaised_m = 0.4;
/// Behind a turnout, tracks are kMovedApart_m from each other after this much at most.
inline constexpr double kMeeting_m = 50.0;

/// Moves a run to kMovedApart_m from the tracks to which it is nearer than kApart_m, to the side on
/// which the map has it before and behind. It stays where it is on another side before than behind,
/// where it is between two tracks without room for a third one, where it would be moved by more
/// than kMovedApart_m, that is beyond the other track's axis, and for 50 m where it begins or ends
/// in the other track.
/// @returns It with other points, at most 60 m apart; nothing if it is moved nowhere.
[[nodiscard]] std::optional<TrackRun> MovedApart(const TrackNetwork& network,
                                                 const TrackRun& run,
                                                 const RunFit& fit);

/// Sigma of the points of a run that was moved, which are no mapped ones.
inline constexpr double kMovedSigma_m = 0.1;

}  // namespace railcast
