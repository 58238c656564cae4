#include "core/rail/motion/track_path.h"

#include <array>
#include <cmath>
#include <cstddef>
#include <numbers>
#include <utility>

#include "core/base/units.h"

namespace railcast {
namespace {

/// The pivots of a body whose origin is at some chainage, with the track's frames there.
struct Pivots {
  Transform world_from_front;
  Transform world_from_rear;
};

bool FacesFallingChainage(const TrackPose& pose) {
  return std::cos(pose.heading_rad) < 0.0;
}

Pivots FindPivots(const Alignment& alignment,
                  const TrackCourse& course,
                  const TrackPose& pose,
                  double s_m) {
  const double forwards = FacesFallingChainage(pose) ? -1.0 : 1.0;
  const auto frame_at = [&](double at_m) {
    return course.WorldFromTrack(alignment, at_m, pose.d_m, pose.h_m);
  };
  Pivots pivots{frame_at(s_m), Transform::Identity()};
  // The body is rigid, so the distance that counts is that between the pivots, not the one along
  // the axis. In an arc over which the track turns by the angle 2 p, each step multiplies the error
  // by 1 - p cot p: by 7e-5 for 10 m at R = 350 m.
  constexpr int kNumSteps = 4;
  double along_m = pose.pivot_distance_m;
  for (int step = 0; step < kNumSteps; ++step) {
    const double ahead_m = pose.is_midway ? 0.5 * along_m : 0.0;
    if (pose.is_midway) pivots.world_from_front = frame_at(s_m + forwards * ahead_m);
    pivots.world_from_rear = frame_at(s_m - forwards * (along_m - ahead_m));
    along_m *=
        pose.pivot_distance_m /
        (pivots.world_from_front.translation() - pivots.world_from_rear.translation()).norm();
  }
  return pivots;
}

/// The heading, 0 or 180 degrees, in which something runs that may be turned against its track.
double AlongTrack_rad(const TrackPose& pose) {
  return FacesFallingChainage(pose) ? std::numbers::pi : 0.0;
}

// The pose of a body that rests on the track with two pivots: its x axis is the line through both,
// its roll the mean of the cants there. What is turned against the track turns about its middle.
Transform BodyOn(const Pivots& pivots, const TrackPose& pose) {
  const auto& [front, rear] = pivots;
  const Vector3 x = (front.translation() - rear.translation()).normalized();
  const Vector3 up = front.linear().col(2) + rear.linear().col(2);
  const Vector3 y = up.cross(x).normalized();
  Eigen::Matrix3d world_from_body;
  world_from_body << x, y, x.cross(y);
  if (!pose.is_midway) return MakeTransform(world_from_body, front.translation());
  const double turned_rad = pose.heading_rad - AlongTrack_rad(pose);
  return MakeTransform(world_from_body * RotationFromYawPitchRoll(turned_rad, 0.0, 0.0),
                       0.5 * (front.translation() + rear.translation()));
}

/// A quantity at -2, -1, 0, 1 and 2 differences from the instant.
using FiveVectors = std::array<Vector3, 5>;

Vector3 FirstDerivative(const FiveVectors& at) {
  return (at[0] - at[4] + 8.0 * (at[3] - at[1])) / (12.0 * kDifference_s);
}

Vector3 SecondDerivative(const FiveVectors& at) {
  return (16.0 * (at[1] + at[3]) - at[0] - at[4] - 30.0 * at[2]) /
         (12.0 * kDifference_s * kDifference_s);
}

/// Axis times angle of a small rotation. Unlike Eigen's, it loses no digits near none.
Vector3 SmallRotation_rad(const Eigen::Matrix3d& turn) {
  Vector3 sine(0.5 * (turn(2, 1) - turn(1, 2)), 0.5 * (turn(0, 2) - turn(2, 0)),
               0.5 * (turn(1, 0) - turn(0, 1)));
  const double sine_of_angle = sine.norm();
  if (sine_of_angle == 0.0) return sine;
  const double angle_rad = std::atan2(sine_of_angle, 0.5 * (turn.trace() - 1.0));
  return angle_rad / sine_of_angle * sine;
}

}  // namespace

TrackPath::TrackPath(Route route,
                     const TrackPose& pose,
                     SpeedProfile profile,
                     std::int64_t begin_ns)
    : route_(std::make_shared<const Route>(std::move(route))),
      pose_(pose),
      profile_(std::move(profile)),
      begin_ns_(begin_ns) {}

TrackPath::TrackPath(TrackCourse course,
                     const TrackPose& pose,
                     SpeedProfile profile,
                     std::int64_t begin_ns)
    : TrackPath(Route{.course = std::move(course), .names = {}, .sections = {}, .passages = {}},
                pose,
                std::move(profile),
                begin_ns) {}

TrackPath TrackPath::WithSpeedFrom(std::int64_t from_ns,
                                   double speed_mps,
                                   double acceleration_mps2) const {
  TrackPath changed = *this;
  changed.profile_ =
      profile_.WithSpeedFrom(SecondsFromNs(from_ns - begin_ns_), speed_mps, acceleration_mps2);
  return changed;
}

double TrackPath::SpeedAt_mps(std::int64_t time_ns) const {
  return StateAt(time_ns).speed_mps;
}

SpeedProfile::State TrackPath::StateAt(std::int64_t time_ns) const {
  return profile_.At(SecondsFromNs(time_ns - begin_ns_));
}

double TrackPath::SprungAccelerationAt_mps2(const Suspension& suspension,
                                            std::int64_t time_ns,
                                            double after_s) const {
  return profile_.SprungAcceleration_mps2(suspension, SecondsFromNs(time_ns - begin_ns_), after_s);
}

TrackPath TrackPath::Behind(std::shared_ptr<const TrackLength> length,
                            double behind_m,
                            const TrackPose& pose) const {
  TrackPath behind = *this;
  behind.pose_ = pose;
  behind.length_ = std::move(length);
  behind.behind_m_ += behind_m;
  return behind;
}

double TrackPath::ChainageAt(std::int64_t time_ns) const {
  const double s_m = profile_.At(SecondsFromNs(time_ns - begin_ns_)).s_m;
  if (length_ == nullptr) return s_m;
  return length_->MovedFrom(s_m, profile_.reverse() ? behind_m_ : -behind_m_);
}

std::optional<double> TrackPath::TimeAt_s(double s_m) const {
  std::optional<double> time_s = profile_.TimeAt_s(s_m);
  if (time_s) *time_s += SecondsFromNs(begin_ns_);
  return time_s;
}

Transform TrackPath::WorldFromObjectAt(const Alignment& alignment, double s_m) const {
  if (pose_.pivot_distance_m > 0.0) {
    return BodyOn(FindPivots(alignment, course(), pose_, s_m), pose_);
  }
  const Transform world_from_track = course().WorldFromTrack(alignment, s_m, pose_.d_m, pose_.h_m);
  const Eigen::Matrix3d track_from_object = RotationFromYawPitchRoll(pose_.heading_rad, 0.0, 0.0);
  const Eigen::Matrix3d world_from_object =
      pose_.is_upright ? RotationFromYawPitchRoll(
                             course().Heading_rad(alignment, s_m) + pose_.heading_rad, 0.0, 0.0)
                       : Eigen::Matrix3d(world_from_track.linear() * track_from_object);
  return MakeTransform(world_from_object, world_from_track.translation());
}

std::array<Transform, 3> TrackPath::WorldFromVehicleAt(const Alignment& alignment,
                                                       double s_m) const {
  Pivots pivots = FindPivots(alignment, course(), pose_, s_m);
  const Transform world_from_body = BodyOn(pivots, pose_);
  const Eigen::Matrix3d turn = RotationFromYawPitchRoll(AlongTrack_rad(pose_), 0.0, 0.0);
  pivots.world_from_front.linear() *= turn;
  pivots.world_from_rear.linear() *= turn;
  return {world_from_body, pivots.world_from_front, pivots.world_from_rear};
}

RigidMotion Differentiated(const std::function<Transform(double after_s)>& world_from_body_after) {
  RigidMotion motion;
  motion.world_from_body = world_from_body_after(0.0);
  const Vector3 origin_m = motion.world_from_body.translation();
  const Eigen::Matrix3d body_from_world = motion.world_from_body.linear().transpose();
  FiveVectors places_m;
  // Rotations since the instant, in world axes. At none, the first derivative of axis times angle
  // is the angular velocity, and the second one the angular acceleration.
  FiveVectors turns_rad;
  for (std::size_t i = 0; i < places_m.size(); ++i) {
    const double after_s = (static_cast<double>(i) - 2.0) * kDifference_s;
    const Transform there = i == 2 ? motion.world_from_body : world_from_body_after(after_s);
    places_m[i] = there.translation() - origin_m;
    turns_rad[i] = i == 2 ? Vector3::Zero() : SmallRotation_rad(there.linear() * body_from_world);
  }
  motion.velocity_mps = FirstDerivative(places_m);
  motion.acceleration_mps2 = SecondDerivative(places_m);
  motion.angular_velocity_radps = FirstDerivative(turns_rad);
  motion.angular_acceleration_radps2 = SecondDerivative(turns_rad);
  return motion;
}

RigidMotion MotionOnTrack(
    const TrackPath& path,
    std::int64_t time_ns,
    const std::function<Transform(double s_m, double speed_mps, double after_s)>&
        world_from_body_at) {
  const SpeedProfile::State now = path.StateAt(time_ns);
  const double direction = path.reverse() ? -1.0 : 1.0;
  return Differentiated([&](double after_s) {
    const double later_mps = now.speed_mps + now.acceleration_mps2 * after_s;
    const double ahead_m = 0.5 * (now.speed_mps + later_mps) * after_s;
    return world_from_body_at(now.s_m + direction * ahead_m, later_mps, after_s);
  });
}

}  // namespace railcast
