#pragma once

#include <cstdint>

#include "core/scene/empty_world.h"
#include "railcast/c_api.h"
#include "railcast/transform.h"

namespace railcast {

/// The time of a frame.
struct FrameTime {
  std::int64_t stamp_ns{};
  std::uint32_t duration_ns{};  ///< To the last firing.
};

/// The world of a host's scene during one frame: the vehicle's motion, and nothing else.
class HostMotion final : public EmptyWorld {
 public:
  /// The two parts of a pose, which change independently.
  struct Pose {
    Vector3 position_m;
    Eigen::Quaterniond rotation;
  };

  /// @throws ArgumentError "motion.world_from_sensor.position_m[0]: must be finite (got nan)".
  HostMotion(const railcast_motion& motion,
             const FrameTime& time,
             const Transform& vehicle_from_sensor);

  /// The axes of the rays that the host gets.
  [[nodiscard]] Transform window_from_world() const;

  /// Between the two poses the position changes linearly and the rotation at a constant rate.
  [[nodiscard]] Transform WorldFromVehicle(std::int64_t time_ns) const override;

 private:
  Pose begin_;
  Pose end_;
  Vector3 scene_origin_m_;
  FrameTime time_;
  Transform sensor_from_vehicle_;
};

/// A transform as the C interface has it, with w >= 0.
[[nodiscard]] railcast_pose PoseOf(const Transform& transform);

}  // namespace railcast
