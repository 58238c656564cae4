#pragma once

#include <cstdint>
#include <vector>

#include "railcast/frame.h"
#include "railcast/transform.h"

namespace railcast {

/// The sensor's motion during one scan, for undoing it (motion compensation, de-skewing).
///
/// Between two known poses the position is interpolated linearly and the rotation at a constant
/// rate, which is wrong by a dt^2 / 8. Frames of ours have a pose every 20 ms (PosesBetween). Where
/// only those at the stamp and at the last firing are known, as of live frames and of sequences of
/// older programs, an acceleration of 2 m/s^2 amounts to 2.5 mm in the middle of a scan of 0.1 s.
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
  /// From one known pose to the next.
  struct Leg {
    std::uint32_t begin_ns{};
    double legs_per_ns{};
    Transform stamp_from_begin;
    Vector3 travel_m;  ///< In the sensor's axes at the begin, as is `turn`.
    Eigen::AngleAxisd turn;
  };
  void AddLeg(const ScanPose& begin, const ScanPose& end, const Transform& stamp_from_world);
  [[nodiscard]] const Leg& LegAt(std::uint32_t time_ns) const;

  std::vector<Leg> legs_;  ///< At least one.
};

}  // namespace railcast
