#pragma once

#include <Eigen/Core>
#include <array>
#include <string>
#include <vector>

#include "generator/extras/import/map/rail_map.h"
#include "railcast/alignment.h"

namespace railcast {

/// Where a map's metres begin, and how they follow from degrees.
struct MapProjection {
  /// For PROJ. The local one of ProjectMap is a transverse Mercator about the map's middle with
  /// scale 1, so that lengths are true to 1.2e-8 times the square of the distance in km from its
  /// meridian: to 5 mm in a kilometre 20 km away.
  std::string definition;
  /// Easting and northing that were subtracted.
  Eigen::Vector2d origin_m = Eigen::Vector2d::Zero();
  /// As MapSpec has them, so that a scenario can place things by longitude and latitude.
  Eigen::Vector2d middle_deg = Eigen::Vector2d::Zero();
  std::vector<std::array<double, 2>> coefficients_m{};
  /// By how much a scenario's longitudes and latitudes miss the map's points at most. Systems with
  /// a grid of corrections, as of the German surveys, are no smoother than some centimetres.
  double geographic_error_m = 0.0;
};

/// The same for the alignment of a world.
[[nodiscard]] MapSpec MapSpecOf(const MapProjection& projection);

/// Sets MapNode::place_m of all nodes.
/// @param definition Whatever PROJ takes for a projected system in metres ("EPSG:31256"); empty: a
///   local one.
/// @throws InputError "--crs: ..." if PROJ does not know it, if it is no projected system in
/// metres,
///   if its scale in the middle of the map is not within 1 % of 1, if a node lies outside of where
///   it can be used, or if it is no polynomial of the local one to 1 m; without "--crs: " if that
///   is so of the local one.
[[nodiscard]] MapProjection ProjectMap(const std::string& definition, RailMap& map);

}  // namespace railcast
