#include "core/io/scan_motion.h"

namespace railcast {

ScanMotion::ScanMotion(const Frame& frame)
    // In an instantaneous scan all times are 0, so any finite factor will do.
    : scans_per_ns_(frame.duration_ns > 0 ? 1.0 / frame.duration_ns : 0.0) {
  const Transform stamp_from_end = frame.world_from_sensor.inverse() * frame.world_from_sensor_end;
  travel_m_ = stamp_from_end.translation();
  turn_ = Eigen::AngleAxisd(stamp_from_end.linear());
}

Vector3 ScanMotion::AtStamp(const Vector3& point_m, std::uint32_t time_ns) const {
  const double share = time_ns * scans_per_ns_;
  return Eigen::AngleAxisd(share * turn_.angle(), turn_.axis()) * point_m + share * travel_m_;
}

Vector3 ScanMotion::AtFiring(const Vector3& point_at_stamp_m, std::uint32_t time_ns) const {
  const double share = time_ns * scans_per_ns_;
  return Eigen::AngleAxisd(-share * turn_.angle(), turn_.axis()) *
         (point_at_stamp_m - share * travel_m_);
}

}  // namespace railcast
