#include "core/rail/line/track_path.h"

#include <utility>

#include "core/base/units.h"

namespace railcast {

TrackPath::TrackPath(const TrackPose& pose, SpeedProfile profile, std::int64_t begin_ns)
    : pose_(pose), profile_(std::move(profile)), begin_ns_(begin_ns) {}

TrackPath TrackPath::WithSpeedFrom(std::int64_t from_ns,
                                   double speed_mps,
                                   double acceleration_mps2) const {
  return TrackPath(
      pose_,
      profile_.WithSpeedFrom(SecondsFromNs(from_ns - begin_ns_), speed_mps, acceleration_mps2),
      begin_ns_);
}

double TrackPath::SpeedAt_mps(std::int64_t time_ns) const {
  return profile_.At(SecondsFromNs(time_ns - begin_ns_)).speed_mps;
}

double TrackPath::ChainageAt(std::int64_t time_ns) const {
  return profile_.At(SecondsFromNs(time_ns - begin_ns_)).s_m;
}

Transform TrackPath::WorldFromObject(const Alignment& alignment, std::int64_t time_ns) const {
  const double s_m = ChainageAt(time_ns);
  const Transform world_from_track = alignment.WorldFromTrack(s_m, pose_.d_m, pose_.h_m);
  const Eigen::Matrix3d track_from_object = RotationFromYawPitchRoll(pose_.heading_rad, 0.0, 0.0);
  const Eigen::Matrix3d world_from_object =
      pose_.is_upright
          ? RotationFromYawPitchRoll(alignment.At(s_m).heading_rad + pose_.heading_rad, 0.0, 0.0)
          : Eigen::Matrix3d(world_from_track.linear() * track_from_object);
  return MakeTransform(world_from_object, world_from_track.translation());
}

}  // namespace railcast
