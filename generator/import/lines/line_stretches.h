#pragma once

#include <cstddef>
#include <functional>
#include <span>
#include <string_view>
#include <vector>

#include "generator/import/lines/track_lines.h"
#include "generator/import/map/rail_map.h"

namespace railcast {

/// A part of a line between two chainages.
struct LineStretch {
  double begin_s_m{};
  double end_s_m{};
  std::size_t way{};  ///< Of the map: the first of those on it.
};

/// The ways of a line from node to node.
/// @param chainages_m Of the line's nodes.
[[nodiscard]] std::vector<LineStretch> WaysAlong(const TrackLine& line,
                                                 std::span<const double> chainages_m);

/// Where ways along a line have something in common: neighbouring ways that have it make one
/// stretch. Stretches are in order of chainage and longer than 0.
[[nodiscard]] std::vector<LineStretch> StretchesWhere(
    const RailMap& map,
    std::span<const LineStretch> ways,
    const std::function<bool(const MapTags&)>& has);

/// The same for the ways of a line.
/// @param chainages_m Of the line's nodes.
[[nodiscard]] std::vector<LineStretch> StretchesWhere(
    const RailMap& map,
    const TrackLine& line,
    std::span<const double> chainages_m,
    const std::function<bool(const MapTags&)>& has);

/// Whether a value of OpenStreetMap says that a thing is there: anything but "" and "no".
[[nodiscard]] inline bool IsThere(std::string_view value) {
  return !value.empty() && value != "no";
}

}  // namespace railcast
