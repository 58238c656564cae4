#pragma once

#include <cstdint>
#include <vector>

#include "core/io/ouster/ouster_packet.h"
#include "railcast/frame.h"
#include "railcast/transform.h"

namespace railcast {

/// The motion of a sensor during a frame, as an ideal inertial sensor within it measures it.
///
/// It follows from the poses of the frame: a parabola through the three poses about a time gives
/// the acceleration, and the turn between two of them the rotation. Beyond the last firing, motion
/// goes on as at the end.
class PoseMotion {
 public:
  PoseMotion(const Frame& frame, const Transform& sensor_from_imu);

  /// What is measured at a simulation time; its times are not set.
  [[nodiscard]] OusterImu At(std::int64_t time_ns) const;

 private:
  struct Knot {
    std::int64_t time_ns{};
    Transform world_from_imu = Transform::Identity();
  };
  std::vector<Knot> knots_;
};

}  // namespace railcast
