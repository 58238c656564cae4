#pragma once

#include <cstddef>
#include <vector>

#include "generator/import/lines/imported_line.h"
#include "generator/import/lines/track_lines.h"
#include "generator/import/map/rail_map.h"
#include "generator/import/network/line_world.h"

namespace railcast {

/// How the tracks beside a line came out.
struct SideTrackQuality {
  std::size_t num_tracks{};
  std::size_t num_turnouts{};
  double length_m{};
  std::vector<double> distances_m;  ///< Of the map's points from their tracks, ascending.
  /// From the map's switches to the beginnings of their turnouts, along the line, ascending.
  std::vector<double> shifts_m;
};

/// Adds the tracks of the map that run along a line, within 60 m of it, to its world.
///
/// Ways are followed straight on as those of lines are, whatever their `service`, and cut into runs
/// with rising chainage that keep within 20 degrees of the line (FindRuns). A run becomes,
/// whichever is possible first,
/// - a track parallel to the line but for S-curves (LevelsOf), with turnouts where its ends meet
///   other tracks;
/// - straights, arcs and clothoids in the plane of chainage and offset (FitLine), with turnouts at
///   such ends, to which arcs lead (TurnoutChoices);
/// - the same moved away from tracks to which the map has it too near (MovedApart);
/// - two such tracks, one from each end, and ones without turnouts, as far as they are apart from
///   all others.
/// Tunnels of a run in which it crosses below the line are left out with their track. Whatever of a
/// run is in no track, and each switch that is no turnout, is a LeftOut with its reason.
[[nodiscard]] SideTrackQuality AddSideTracks(const RailMap& map,
                                             const TrackLine& track,
                                             const ImportedLine& line,
                                             const ImportOptions& options,
                                             LineWorld& world);

}  // namespace railcast
