#pragma once

#include <string>
#include <vector>

#include "core/rail/network/world_tracks.h"
#include "generator/import/lines/imported_line.h"
#include "generator/import/lines/track_lines.h"
#include "generator/import/map/rail_map.h"
#include "generator/import/network/line_world.h"
#include "railcast/rail_world.h"
#include "railcast/world_spec.h"

namespace railcast {

/// Adds what the map has on and beside the tracks of a world.
///
/// Bridges, tunnels, slab track and conductor rails come from the tags of all tracks' ways
/// (AddWayStructures), platforms from outlines and lines (AddPlatforms). Things that stand on the
/// line, within 2 m of its axis, become level crossings, signals, kilometre boards, derailers and,
/// at its ends, buffer stops.
void AddStructures(const RailMap& map,
                   const TrackLine& track,
                   const ImportedLine& line,
                   LineWorld& world);

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
