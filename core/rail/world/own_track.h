#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "core/rail/clearance/clear_space.h"
#include "core/rail/line/track_course.h"
#include "railcast/alignment.h"
#include "railcast/rail_world.h"
#include "railcast/transform.h"
#include "railcast/world_spec.h"

namespace railcast {

/// A place in a track's axes: where the cross-section that holds it cuts the track, and where it
/// lies in that cross-section, which is square to the track and canted with it.
struct PlaceByTrack {
  double chainage_m{};  ///< Chainage of the alignment, along the route.
  double lateral_m{};   ///< From the track's axis in the plane of the rails, left positive.
  double height_m{};    ///< Above top of rail, square to that plane.
};

/// The track that the vehicle is on, along its route: where things are in its axes, and whether
/// they reach into the outline of vehicles on it. Immutable, thread-safe.
class OwnTrack {
 public:
  /// @param catenary Of the world; its wires make the outline higher.
  /// @param gauge In which things are in the way; empty = VehicleOutline().
  OwnTrack(const RailWorld& world, const CatenarySpec& catenary, std::vector<GaugePart> gauge = {});

  [[nodiscard]] const std::vector<GaugePart>& gauge() const { return gauge_; }
  [[nodiscard]] double begin_s_m() const { return track_.begin_s_m(); }
  [[nodiscard]] double end_s_m() const { return track_.end_s_m(); }
  [[nodiscard]] Transform WorldFromTrack(double s_m) const {
    return track_.WorldFromTrack(alignment_, s_m);
  }

  /// Where a point is, at the point of the axis that is nearest to it; nothing beyond the ends of
  /// the track. Between points of the axis 1 m apart, the track is taken to be curved evenly. That
  /// is exact to 1 mm within 250 m of the axis but for the chainage where the curvature jumps, as
  /// at the toe of a turnout of R = 190 m: of what stands y aside, it may err by y / (4 * 190).
  /// @param near_s_m Where the search begins, such as the chainage of a neighbour. It changes how
  ///   long the search takes, not what it finds.
  [[nodiscard]] std::optional<PlaceByTrack> PlaceOf(const Vector3& world_m, double near_s_m) const;

  /// Chainage of the point of the axis that is nearest to this point, or of the track's tangent
  /// beyond its ends.
  [[nodiscard]] double ChainageNear_m(const Vector3& world_m) const;

  /// Whether a place is inside the gauge; its boundary is not.
  [[nodiscard]] bool IsInGauge(const PlaceByTrack& place) const;

  /// Position of a box relative to the gauge of the track ahead, where it comes nearest to it. A
  /// box behind the vehicle or beyond the ends of the track is not inside, at an infinite distance
  /// from the axis.
  [[nodiscard]] GaugeClearance ClearanceAhead(const Transform& world_from_vehicle,
                                              const Transform& world_from_box,
                                              const Vector3& size_m) const;

 private:
  /// A point of the axis and the track's axes there.
  [[nodiscard]] double ChainageOf_m(std::size_t i) const {
    return track_.begin_s_m() + step_m_ * static_cast<double>(i);
  }
  [[nodiscard]] std::size_t NearestTo(const Vector3& world_m, double near_s_m) const;
  /// As ChainageNear_m(), but starts from a nearby chainage.
  [[nodiscard]] double Refined_m(double s_m, const Vector3& world_m) const;

  Alignment alignment_;
  TrackCourse track_;
  std::vector<GaugePart> gauge_;
  double step_m_{};  ///< Step of chainage, from one point of the axis to the next.
  /// The points of the axis from the track's begin to its end, and the track's axes there.
  std::vector<Vector3> axis_m_;
  std::vector<Eigen::Matrix3d> world_from_track_;
  double longest_step_m_{};  ///< The greatest distance from one point of the axis to the next.
};

}  // namespace railcast
