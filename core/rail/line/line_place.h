#pragma once

#include <Eigen/Core>
#include <vector>

#include "core/rail/line/track_course.h"
#include "railcast/alignment.h"
#include "railcast/transform.h"

namespace railcast {

/// A place in the world as seen from the alignment.
struct PlaceBesideLine {
  double s_m{};  ///< Chainage of the axis point beside which it lies in plan.
  double d_m{};  ///< Left of that point, horizontally.
  double h_m{};  ///< Above it, vertically.
};

/// Finds a place in the world by steps along the line, to 1 um of chainage where they converge:
/// from a chainage that is nearer than the centre of a curve.
[[nodiscard]] PlaceBesideLine PlaceOnLine(const Alignment& alignment,
                                          const Vector3& place_world_m,
                                          double near_s_m);

/// Places of the line count as equally near to something if their distances differ by less.
inline constexpr double kTie_m = 0.01;

/// Where the line is nearest to a place in plan, in the order of chainages: usually one place, and
/// several if these are equally near, as in the middle of an arc. Beyond an end, on the straight
/// that continues it. Of what is farther away than 2 km, which no ground is, only about where, with
/// the distance to either side as d_m.
/// @pre The place is finite.
[[nodiscard]] std::vector<PlaceBesideLine> NearestOnLine(const Alignment& alignment,
                                                         const Eigen::Vector2d& place_m);

/// Where a place in plan lies beside a track.
struct PlaceBesideTrack {
  double s_m{};  ///< Chainage of the point of the track's axis beside which it lies.
  double d_m{};  ///< Left of that point.
};

/// The inverse of TrackCourse::WorldFromTrack() in plan, found as PlaceOnLine() does.
[[nodiscard]] PlaceBesideTrack PlaceOnTrack(const Alignment& alignment,
                                            const TrackCourse& course,
                                            const Eigen::Vector2d& place_m,
                                            double near_s_m);

}  // namespace railcast
