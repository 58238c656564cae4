#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "generator/import/map/rail_map.h"

namespace railcast {

/// A track through the map, over switches straight on.
struct TrackLine {
  std::string name;  ///< Unique, and fit for a file name: "westbahn-101-01".
  /// Nodes in order.
  std::vector<std::size_t> nodes;
  /// ways[i] leads from nodes[i] to nodes[i + 1].
  std::vector<std::size_t> ways;
};

/// Divides the running tracks of a map (those without `service`) into lines.
///
/// The longest way that is left is continued at both ends for as long as there is a way that turns
/// by at most 20 degrees; of several, that with the smallest angle, where a change of `ref` counts
/// as 6 degrees. Every way is part of one line at most. Ways may end in the middle of others.
/// @param shortest_m Lines shorter than this are left out.
/// @returns The longest line first.
[[nodiscard]] std::vector<TrackLine> FindLines(const RailMap& map, double shortest_m);

/// Length of a line along its points.
[[nodiscard]] double LengthOf_m(const RailMap& map, const TrackLine& line);

}  // namespace railcast
