#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>

#include "core/rail/line/track_course.h"
#include "core/rail/motion/speed_profile.h"
#include "core/rail/network/route.h"
#include "railcast/alignment.h"
#include "railcast/rigid_motion.h"
#include "railcast/transform.h"

namespace railcast {

/// Position of an object across a track, and its orientation.
struct TrackPose {
  double d_m{};          ///< From the track's axis, left positive.
  double h_m{};          ///< Above top of rail.
  double heading_rad{};  ///< Counterclockwise from the track towards rising chainage.
  bool is_upright{};  ///< Whether its z axis is vertical; otherwise it follows gradient and cant.
  /// Distance between the two pivots on which the object rests: its x axis leads from the rear one
  /// to the front one. 0 = it follows the track's tangent.
  double pivot_distance_m{};
  /// Whether its origin lies midway between the pivots, which are then equally far from its
  /// chainage; otherwise the front pivot is at its origin.
  bool is_midway{};
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

  /// The path of something coupled to what follows this one: `behind_m` behind it, measured along
  /// the track.
  /// @param length Of this path's course.
  [[nodiscard]] TrackPath Behind(std::shared_ptr<const TrackLength> length,
                                 double behind_m,
                                 const TrackPose& pose) const;

  [[nodiscard]] const Route& route() const { return *route_; }
  [[nodiscard]] const TrackCourse& course() const { return route_->course; }
  [[nodiscard]] const TrackPose& pose() const { return pose_; }
  [[nodiscard]] bool moves() const { return profile_.moves(); }
  [[nodiscard]] double SpeedAt_mps(std::int64_t time_ns) const;
  /// The profile's state: of something that is behind another one, that of the foremost.
  [[nodiscard]] SpeedProfile::State StateAt(std::int64_t time_ns) const;
  /// SpeedProfile::SprungAcceleration_mps2() of the same.
  [[nodiscard]] double SprungAccelerationAt_mps2(const Suspension& suspension,
                                                 std::int64_t time_ns,
                                                 double after_s = 0.0) const;
  [[nodiscard]] double ChainageAt(std::int64_t time_ns) const;
  /// When the object comes to the chainage; absent if it lies behind or is never reached.
  [[nodiscard]] std::optional<double> TimeAt_s(double s_m) const;
  [[nodiscard]] bool reverse() const { return profile_.reverse(); }
  [[nodiscard]] Transform WorldFromObject(const Alignment& alignment, std::int64_t time_ns) const {
    return WorldFromObjectAt(alignment, ChainageAt(time_ns));
  }
  [[nodiscard]] Transform WorldFromObjectAt(const Alignment& alignment, double s_m) const;
  /// The body, its front bogie and its rear one. The origins of the bogies are at the pivots, and
  /// their axes are those of the track there.
  /// @pre The pose has pivots.
  [[nodiscard]] std::array<Transform, 3> WorldFromVehicleAt(const Alignment& alignment,
                                                            double s_m) const;

 private:
  std::shared_ptr<const Route> route_;
  TrackPose pose_;
  SpeedProfile profile_;
  std::int64_t begin_ns_;
  std::shared_ptr<const TrackLength> length_;  ///< Null unless it is behind something.
  double behind_m_ = 0.0;
};

/// The motion of a body whose pose is a function of time, by central differences of five poses,
/// kDifference_s apart from one another.
///
/// Of a part of the motion that is a wave of the angular frequency w, first derivatives are wrong
/// by (w h)^4 / 30 of themselves and second ones by (w h)^4 / 90, with h = kDifference_s. Of the
/// track's shortest irregularity, 3 m, at 40 m/s these are 0.04 and 0.014 %. Coordinates that are
/// rounded by e add at most 5.4 e / h^2 to an acceleration: 0.000003 m/s^2 within 60 km of the
/// world's origin.
///
/// @param world_from_body_after The pose so many seconds after the instant.
[[nodiscard]] RigidMotion Differentiated(
    const std::function<Transform(double after_s)>& world_from_body_after);

inline constexpr double kDifference_s = 0.004;

/// The motion of something on a track, whose pose is a function of chainage, speed and the time
/// since `time_ns`. The stretch of constant acceleration that the time is in is continued beyond
/// its ends, so that a jump of the acceleration is not blurred.
[[nodiscard]] RigidMotion MotionOnTrack(
    const TrackPath& path,
    std::int64_t time_ns,
    const std::function<Transform(double s_m, double speed_mps, double after_s)>&
        world_from_body_at);

}  // namespace railcast
