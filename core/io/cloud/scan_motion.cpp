#include "core/io/cloud/scan_motion.h"

#include <algorithm>

namespace railcast {

ScanMotion::ScanMotion(const Frame& frame) {
  const Transform stamp_from_world = frame.world_from_sensor.inverse();
  ScanPose begin{0, frame.world_from_sensor};
  for (const ScanPose& pose : frame.poses_between) {
    AddLeg(begin, pose, stamp_from_world);
    begin = pose;
  }
  AddLeg(begin, {frame.duration_ns, frame.world_from_sensor_end}, stamp_from_world);
}

void ScanMotion::AddLeg(const ScanPose& begin,
                        const ScanPose& end,
                        const Transform& stamp_from_world) {
  const Transform begin_from_end = begin.world_from_sensor.inverse() * end.world_from_sensor;
  // In an instantaneous scan all times are 0, so any finite factor will do.
  const double legs_per_ns = end.time_ns > begin.time_ns ? 1.0 / (end.time_ns - begin.time_ns) : 0;
  // The first begins at the stamp itself, without rounding.
  const Transform stamp_from_begin =
      legs_.empty() ? Transform::Identity() : stamp_from_world * begin.world_from_sensor;
  legs_.push_back({begin.time_ns, legs_per_ns, stamp_from_begin, begin_from_end.translation(),
                   Eigen::AngleAxisd(begin_from_end.linear())});
}

const ScanMotion::Leg& ScanMotion::LegAt(std::uint32_t time_ns) const {
  const auto after =
      std::upper_bound(legs_.begin() + 1, legs_.end(), time_ns,
                       [](std::uint32_t time, const Leg& leg) { return time < leg.begin_ns; });
  return *(after - 1);
}

Vector3 ScanMotion::AtStamp(const Vector3& point_m, std::uint32_t time_ns) const {
  const Leg& leg = LegAt(time_ns);
  const double share = (time_ns - leg.begin_ns) * leg.legs_per_ns;
  return leg.stamp_from_begin *
         (Eigen::AngleAxisd(share * leg.turn.angle(), leg.turn.axis()) * point_m +
          share * leg.travel_m);
}

Vector3 ScanMotion::AtFiring(const Vector3& point_at_stamp_m, std::uint32_t time_ns) const {
  const Leg& leg = LegAt(time_ns);
  const double share = (time_ns - leg.begin_ns) * leg.legs_per_ns;
  return Eigen::AngleAxisd(-share * leg.turn.angle(), leg.turn.axis()) *
         (leg.stamp_from_begin.inverse() * point_at_stamp_m - share * leg.travel_m);
}

}  // namespace railcast
