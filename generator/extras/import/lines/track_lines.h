#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "generator/extras/import/map/rail_map.h"

namespace railcast {

/// A track through the map, over switches straight on.
struct TrackLine {
  std::string name;  ///< Unique, and fit for a file name (100 bytes at most): "westbahn-101-01".
  /// Nodes in order, each at least 0.5 m from the one before.
  std::vector<std::size_t> nodes;
  /// ways[i] leads to nodes[i + 1], from nodes[i] or from one that was left out behind it.
  std::vector<std::size_t> ways;
};

/// A line, or a part of one, that cannot stand.
struct LeftOutLine {
  TrackLine track;
  double length_m{};  ///< Length of its part that cannot stand.
  std::string reason;
};

/// Nodes of a line are at least so far apart: mappers put two points a few centimetres apart where
/// two ways were joined.
inline constexpr double kNearestNodes_m = 0.5;

/// Divides the running tracks of a map (those without `service`) into lines.
///
/// The longest way that is left is continued at both ends for as long as there is a way that turns
/// by at most 20 degrees; of several, that with the smallest angle, where a change of `ref` counts
/// as 6 degrees. Directions are those to the first point at least 5 m away. Every way is followed
/// once at most. Ways may end in the middle of others. Where a way turns back, by more than 90
/// degrees, its line ends and another begins, and a line is divided where it meets itself
/// (DividedWhereItMeetsItself).
/// @param shortest_m Lines shorter than this are left out, and those whose points are all nearer
///   than 0.5 m to the first one.
/// @returns The longest line first.
[[nodiscard]] std::vector<TrackLine> FindLines(const RailMap& map, double shortest_m);

/// Length from a node of a line to its next one.
[[nodiscard]] double StepLength_m(const RailMap& map, const TrackLine& line, std::size_t node);

/// Length of a way along its points.
[[nodiscard]] double LengthOf_m(const RailMap& map, const MapWay& way);

/// Length of a line along its points.
[[nodiscard]] double LengthOf_m(const RailMap& map, const TrackLine& line);

}  // namespace railcast
