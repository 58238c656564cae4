#pragma once

#include <Eigen/Core>

#include "railcast/alignment.h"

namespace railcast {

/// A place of the map's projection in the plan of the world.
[[nodiscard]] Eigen::Vector2d WorldFromProjection(const MapSpec& map,
                                                  const Eigen::Vector2d& place_m);

/// A place on the Earth (WGS 84) in the plan of the world; NaN a quarter of a turn away from the
/// map's longitude.
///
/// The transverse Mercator of the ellipsoid with scale 1 about the map's longitude and latitude, by
/// Krueger's series to the fourth order of the third flattening, which is exact to 1 um within
/// 3,000 km (Karney, "Transverse Mercator with an accuracy of a few nanometers", J. Geodesy 85,
/// 2011, equations 7 to 11 and 35). Other projections are a polynomial of it (MapSpec).
[[nodiscard]] Eigen::Vector2d WorldFromGeographic(const MapSpec& map,
                                                  double longitude_deg,
                                                  double latitude_deg);

/// Longitude and latitude in degrees of a place in the plan of the world: the inverse of
/// WorldFromGeographic(), by Newton's method to 1 um on the ground. NaN where there is none near.
[[nodiscard]] Eigen::Vector2d GeographicFromWorld(const MapSpec& map,
                                                  const Eigen::Vector2d& place_m);

}  // namespace railcast
