#pragma once

#include <Eigen/Geometry>
#include <filesystem>

#include "generator/extras/import/map/rail_map.h"

namespace railcast {

/// Reads a map in any of the formats that import takes, which is told by its content.
/// @throws InputError as the readers of the formats do (map_formats.h), if neighbouring
///   points are more than 50 km apart, or if a track is where only exchanged longitudes and
///   latitudes put it.
[[nodiscard]] RailMap ReadMap(const std::filesystem::path& file);

/// Keeps of a map what lies within a rectangle of longitudes and latitudes.
///
/// A way is cut where a point of it lies outside: each run of two or more points inside stays as a
/// way of its own, with the tags of the whole. Things of which a point lies outside are left out.
/// Call it before ProjectMap, which takes the middle of what is left.
[[nodiscard]] RailMap CropMap(const RailMap& map, const Eigen::AlignedBox2d& within_deg);

}  // namespace railcast
