#pragma once

#include <Eigen/Core>
#include <string>

#include "generator/import/map/rail_map.h"

namespace railcast {

/// Where a map's metres begin, and how they follow from degrees.
struct MapProjection {
  /// For PROJ. The local one of ProjectMap is a transverse Mercator about the map's middle with
  /// scale 1, so that lengths are true to 1.2e-8 times the square of the distance in km from its
  /// meridian: to 5 mm in a kilometre 20 km away.
  std::string definition;
  /// Easting and northing that were subtracted.
  Eigen::Vector2d origin_m = Eigen::Vector2d::Zero();
};

/// Sets MapNode::place_m of all nodes.
/// @param definition Whatever PROJ takes for a projected system in metres ("EPSG:31256"); empty: a
///   local one.
/// @throws InputError "--crs: ..." if PROJ does not know it, if it is no projected system in
/// metres,
///   if its scale in the middle of the map is not within 1 % of 1, or if a node lies outside of
///   where it can be used; without "--crs: " if that is so of the local one.
[[nodiscard]] MapProjection ProjectMap(const std::string& definition, RailMap& map);

}  // namespace railcast
