#pragma once

#include <cstddef>
#include <limits>
#include <string>
#include <vector>

#include "core/rail/line/track_course.h"
#include "generator/extras/import/lines/imported_line.h"
#include "generator/extras/import/lines/line_places.h"
#include "generator/extras/import/lines/track_lines.h"
#include "generator/extras/import/map/rail_map.h"
#include "generator/extras/import/network/track_network.h"
#include "generator/extras/import/network/track_runs.h"
#include "railcast/rail_world.h"
#include "railcast/structures.h"
#include "railcast/world_spec.h"

namespace railcast {

inline constexpr std::size_t kUnknownSource = std::numeric_limits<std::size_t>::max();

/// Something on the map that a world cannot have as it is.
struct LeftOut {
  std::string what;
  double begin_s_m{};
  double end_s_m{};  ///< The same for what stands at one place.
  std::string reason;
  /// The number of a track's run, the node of a switch, or the MapThing of what stands there.
  std::size_t source = kUnknownSource;
};

/// A track of a world and where it comes from.
struct WorldTrack {
  TrackDraft draft;
  std::vector<LineStretch> ways;  ///< Ways of the map, from point to point; they may reach farther.
  std::size_t run = kUnknownSource;  ///< Its number; none of the line's own track.
  /// Chainages of the map's points beside it, and how far to the left of it they are.
  std::vector<Eigen::Vector2d> off_m{};

  /// How far to the left of it the map has it: between points linear.
  [[nodiscard]] double OffAt_m(double s_m) const;
};

/// A switch of the map that is a turnout of a world, or a place where tracks cross on both.
struct MadeSwitch {
  std::size_t node{};
  double s_m{};
  std::string branch;  ///< Name of the track that begins or ends in it, or crosses another one.
};

/// A stretch of a track of which the map's points are more than kFarOff_m from it: it was moved
/// away from others, to which the map has it too near, or its elements do not fit better.
struct MovedTrack {
  std::string name;
  double begin_s_m{};
  double end_s_m{};
  double most_m{};  ///< Greatest distance of the points from it.
};

/// What a MapThing became, without its name.
struct MadeThing {
  std::size_t thing{};
  StructureSpec structure;
};

/// How the tracks beside a line came out.
struct SideTrackQuality {
  std::size_t num_tracks{};
  std::size_t num_turnouts{};
  double length_m{};
  std::vector<double> distances_m;  ///< Distances of the map's points from their tracks, ascending.
  std::size_t num_switches{};       ///< Mapped ones, on tracks; those made are LineWorld::switches.
  /// From the map's switches to the beginnings of their turnouts, along the line, ascending.
  std::vector<double> shifts_m;
};

/// What a world has besides its alignment.
struct LineWorld {
  std::vector<WorldTrack> tracks;  ///< The first is "main".
  std::vector<DiamondCrossingSpec> crossings;
  std::vector<ChainageRange> level;  ///< Where these lie, without cant that was not surveyed.
  std::vector<StructureSpec> structures;
  RunsBeside beside;  ///< The tracks of the map beside the line, made or not.
  std::vector<MadeSwitch> switches;
  std::vector<MadeThing> placed;  ///< They stand unless they were left out later.
  std::vector<LeftOut> left_out;
  SideTrackQuality quality;
};

inline constexpr double kFarOff_m = 0.5;

/// The stretches of a world's tracks that are kFarOff_m or more from where the map has them.
[[nodiscard]] std::vector<MovedTrack> MovedTracksOf(const LineWorld& world);

/// Begins a world with the track of its line. AddSideTracks and AddStructures add the rest.
[[nodiscard]] LineWorld MakeLineWorld(const RailMap& map,
                                      const TrackLine& track,
                                      const ImportedLine& line);

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
/// Where two tracks cross at a node of the map they do so in a diamond, unless the line has
/// surveyed cant there or a turnout lies in it. Tunnels of a run in which it crosses below the line
/// are left out with their track. Whatever of a run is in no track, and each switch that is no
/// turnout, is a LeftOut with its reason.
void AddSideTracks(const RailMap& map,
                   const TrackLine& track,
                   const ImportedLine& line,
                   const ImportOptions& options,
                   LineWorld& world);

/// The stretch of its run that a track has. One that begins or ends in a turnout, or within 2 m
/// of an end of its run, reaches to that end.
/// @pre The track has a run.
[[nodiscard]] ChainageRange RangeInRun(const LineWorld& world, const WorldTrack& track);

/// Why a switch is no turnout that is on none of a world's tracks.
inline constexpr const char* kOnNoTrack = "it lies on no track of the world";
/// Why one at an end of a line is none.
inline constexpr const char* kAtLinesEnd = "the line ends there";

}  // namespace railcast
