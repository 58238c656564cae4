#pragma once

#include <cstddef>
#include <functional>
#include <string>
#include <vector>

#include "core/rail/network/world_tracks.h"
#include "generator/extras/import/lines/imported_line.h"
#include "generator/extras/import/lines/line_places.h"
#include "generator/extras/import/lines/track_lines.h"
#include "generator/extras/import/map/rail_map.h"
#include "generator/extras/import/network/line_world.h"
#include "railcast/rail_world.h"
#include "railcast/world_spec.h"

namespace railcast {

/// Adds what the map has on and beside the tracks of a world.
///
/// Bridges, tunnels, slab track and conductor rails come from the tags of all tracks' ways
/// (AddWayStructures), platforms from outlines and lines (AddPlatform). Points on tracks become
/// level crossings, signals, kilometre boards, derailers and, at their ends, buffer stops
/// (AddPoint).
void AddStructures(const RailMap& map,
                   const TrackLine& track,
                   const ImportedLine& line,
                   LineWorld& world);

/// Adds tunnels, bridges, slab track and conductor rails where the ways of a world's tracks have
/// them.
///
/// Tracks of which one runs within 5.5 m of the next share a tunnel, and within 7 m a bridge: it
/// follows the main track if that is tagged, else that with the longest tagged stretch, and the
/// stretches of the others that it has room for need none of their own. No tunnel is where a track
/// that has none on the map would run in it; a bridge carries such tracks, too.
void AddWayStructures(const RailMap& map, LineWorld& world);

/// What lies between two chainages of a track.
struct TaggedStretch {
  std::size_t track{};
  double begin_s_m{};
  double end_s_m{};

  [[nodiscard]] double length_m() const { return end_s_m - begin_s_m; }
};

/// Where the ways of a world's tracks have something, in centimetres and on the tracks.
[[nodiscard]] std::vector<TaggedStretch> StretchesOfAll(
    const RailMap& map, const LineWorld& world, const std::function<bool(const MapTags&)>& has);

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

/// Adds the edges of a platform, a line or an outline on the map, to the world.
///
/// At every whole metre of chainage the platform belongs to the next track on either side, if its
/// nearer side is 1 to 4.5 m from that track's axis. Each such stretch of at least 5 m becomes a
/// platform at the usual distance from the axis: as wide as the outline or, between two tracks,
/// half as wide as what lies between the edges. Where the width changes by more than 0.5 m, another
/// one begins, but not within 20 m.
/// @param number Of the thing on the map.
void AddPlatform(const MapThing& thing,
                 std::size_t number,
                 const LinePlaces& places,
                 LineWorld& world);

/// Adds a point of the map that is a thing to the world, if it is on one of its tracks: within 2 m
/// of where the map has that. Level crossings within 10 m of each other are on one road.
/// @param number Of the thing.
void AddPoint(const RailMap& map, std::size_t number, const LinePlaces& places, LineWorld& world);

/// Whether a platform is an outline, not a line.
[[nodiscard]] bool IsOutline(const MapThing& platform);

/// Numbers things of a kind: platform_1, platform_2.
void NameStructures(std::vector<StructureSpec>& structures);

/// What is said of a structure that is left out, from where to where it would be.
[[nodiscard]] LeftOut LeftOutOf(const StructureSpec& structure, const std::string& reason);

/// The tracks of a world that is being imported as core has them.
class TracksOfLine {
 public:
  explicit TracksOfLine(const LineWorld& world);

  [[nodiscard]] WorldTracks tracks() const { return {spec_, courses_}; }

 private:
  WorldSpec spec_;
  std::vector<TrackCourse> courses_;
};

}  // namespace railcast
