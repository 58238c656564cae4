#pragma once

#include <Eigen/Core>
#include <optional>
#include <string>
#include <vector>

#include "core/base/error.h"
#include "generator/extras/import/map/rail_map.h"

namespace railcast {

/// A line of a map that may be a track.
struct MapLine {
  std::string place;  ///< For messages: "/features/3".
  std::vector<Eigen::Vector2d> points_deg;
  std::vector<std::optional<double>> heights_m;  ///< As many, or none.
  MapTags tags;
  bool is_area = false;
  bool is_point = false;
};

/// Makes a map of lines, with the remarks that it has.
///
/// If any line has a key `railway` or an `fclass` that is a track, only those are taken that are
/// tracks (IsTrack). Otherwise all lines are, but for those with a key that OpenStreetMap has for
/// roads, waterways and the like. Lines without two different points are left out.
/// Lines meet where they share a point, to the last digit. Lines without `railway` may be those of
/// a receiver on the way: where it stood, its fixes become one point (ThinFixes). Platforms,
/// signals and the like become things; other points are dropped.
/// @throws InputError if no line is a track with two different points, if a track is a polygon, or
///   if its coordinates are no degrees.
[[nodiscard]] RailMap MapOfLines(std::vector<MapLine> lines, std::vector<Remark> remarks);

/// Fixes with those at one place made one. Where a receiver stands, or is slower than its errors
/// are large, its fixes turn back and forth: runs of fixes within 20 m of their mean of which any
/// turns by more than 90 degrees become the mean, with the mean of their heights.
/// @returns How many fixes fewer there are; equal neighbours count as one from the start.
std::size_t ThinFixes(MapLine& line);

}  // namespace railcast
