#pragma once

#include <cstdint>
#include <memory>

#include "core/rail/line/route.h"
#include "core/rail/line/speed_profile.h"
#include "core/rail/line/track_course.h"
#include "railcast/alignment.h"
#include "railcast/transform.h"

namespace railcast {

/// Position of an object across a track, and its orientation.
struct TrackPose {
  double d_m{};          ///< From the track's axis, left positive.
  double h_m{};          ///< Above top of rail.
  double heading_rad{};  ///< Counterclockwise from the track towards rising chainage.
  bool is_upright{};  ///< Whether its z axis is vertical; otherwise it follows gradient and cant.
  /// Distance of a second pivot behind the object's origin: the object's x axis points from there
  /// to the origin. 0 = it follows the track's tangent.
  double pivot_distance_m{};
};

/// The motion of an object or vehicle along a route.
class TrackPath {
 public:
  /// @param begin_ns Time at which the profile's time is 0.
  TrackPath(Route route, const TrackPose& pose, SpeedProfile profile, std::int64_t begin_ns = 0);
  /// Along a single track without a name.
  TrackPath(TrackCourse course,
            const TrackPose& pose,
            SpeedProfile profile,
            std::int64_t begin_ns = 0);

  /// Valid for times from `from_ns` on; see SpeedProfile::WithSpeedFrom.
  [[nodiscard]] TrackPath WithSpeedFrom(std::int64_t from_ns,
                                        double speed_mps,
                                        double acceleration_mps2) const;

  [[nodiscard]] const Route& route() const { return *route_; }
  [[nodiscard]] const TrackCourse& course() const { return route_->course; }
  [[nodiscard]] const TrackPose& pose() const { return pose_; }
  [[nodiscard]] bool moves() const { return profile_.moves(); }
  [[nodiscard]] double SpeedAt_mps(std::int64_t time_ns) const;
  [[nodiscard]] double ChainageAt(std::int64_t time_ns) const;
  [[nodiscard]] Transform WorldFromObject(const Alignment& alignment, std::int64_t time_ns) const {
    return WorldFromObjectAt(alignment, ChainageAt(time_ns));
  }
  [[nodiscard]] Transform WorldFromObjectAt(const Alignment& alignment, double s_m) const;

 private:
  std::shared_ptr<const Route> route_;
  TrackPose pose_;
  SpeedProfile profile_;
  std::int64_t begin_ns_;
};

}  // namespace railcast
