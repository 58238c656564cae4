#pragma once

#include <cstddef>
#include <functional>
#include <string>
#include <vector>

#include "generator/import/lines/imported_line.h"
#include "generator/import/lines/line_places.h"
#include "generator/import/lines/track_lines.h"
#include "generator/import/map/rail_map.h"
#include "generator/import/network/track_network.h"
#include "generator/import/network/track_runs.h"
#include "railcast/rail_world.h"
#include "railcast/structures.h"

namespace railcast {

/// Something on the map that a world cannot have as it is.
struct LeftOut {
  std::string what;
  double begin_s_m{};
  double end_s_m{};  ///< The same for what stands at one place.
  std::string reason;
};

/// A track of a world and where it comes from.
struct WorldTrack {
  TrackDraft draft;
  std::vector<LineStretch> ways;  ///< Of the map, from point to point; they may reach farther.
};

/// A stretch of a track that was moved away from others, to which the map has it too near.
struct MovedTrack {
  std::string name;
  double begin_s_m{};
  double end_s_m{};
  double most_m{};  ///< By which it was moved.
};

/// What a world has besides its alignment.
struct LineWorld {
  std::vector<WorldTrack> tracks;  ///< The first is "main".
  std::vector<StructureSpec> structures;
  /// The tracks of the map beside the line, made or not, and where they were moved to.
  std::vector<TrackRun> runs;
  std::vector<MovedTrack> moved;
  std::vector<LeftOut> left_out;
};

/// Begins a world with the track of its line. AddSideTracks and AddStructures add the rest.
[[nodiscard]] LineWorld MakeLineWorld(const RailMap& map,
                                      const TrackLine& track,
                                      const ImportedLine& line);

/// What lies between two chainages of a track.
struct TaggedStretch {
  std::size_t track{};
  double begin_s_m{};
  double end_s_m{};

  [[nodiscard]] double length_m() const { return end_s_m - begin_s_m; }
};

/// By so much tags of tracks beside each other may begin and end at different chainages.
inline constexpr double kSameEnd_m = 15.0;

/// Whether the tags of a way say that it lies in a tunnel, or on a bridge; never both.
[[nodiscard]] bool IsTunnel(const MapTags& tags);
[[nodiscard]] bool IsBridge(const MapTags& tags);

/// Where the ways of a world's tracks have something, in centimetres and on the tracks.
[[nodiscard]] std::vector<TaggedStretch> StretchesOfAll(
    const RailMap& map, const LineWorld& world, const std::function<bool(const MapTags&)>& has);

}  // namespace railcast
