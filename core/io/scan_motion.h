#pragma once

#include <cstdint>

#include "railcast/frame.h"
#include "railcast/transform.h"

namespace railcast {

/// The sensor's motion during one scan, for undoing it (motion compensation, de-skewing).
///
/// Between the stamp and the last firing the position is interpolated linearly and the rotation at
/// a constant rate. At 10 Hz an acceleration of 2 m/s^2 makes that wrong by a dt^2 / 8 = 2.5 mm in
/// the middle of the scan.
class ScanMotion {
 public:
  explicit ScanMotion(const Frame& frame);

  /// Transforms a point from the sensor's axes at `time_ns` after the stamp to its axes at the
  /// stamp.
  [[nodiscard]] Vector3 AtStamp(const Vector3& point_m, std::uint32_t time_ns) const;
  /// The inverse: transforms a point from the sensor's axes at the stamp to those at `time_ns`
  /// after.
  [[nodiscard]] Vector3 AtFiring(const Vector3& point_at_stamp_m, std::uint32_t time_ns) const;

 private:
  double scans_per_ns_;
  /// Translation from the stamp to the last firing, in the sensor's axes at the stamp.
  Vector3 travel_m_;
  Eigen::AngleAxisd turn_;
};

}  // namespace railcast
