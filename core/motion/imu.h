#pragma once

#include <cstdint>

#include "core/motion/markov_sequence.h"
#include "railcast/motion_sensors.h"
#include "railcast/rigid_motion.h"

namespace railcast {

/// Standard acceleration of free fall (3rd CGPM, 1901).
inline constexpr double kGravity_mps2 = 9.80665;

/// What an IMU with neither bias nor noise measures. The rotation of the Earth is left out.
/// @param vehicle_from_imu Its mount.
[[nodiscard]] ImuSample TrueImuSample(const RigidMotion& vehicle,
                                      const Transform& vehicle_from_imu,
                                      std::int64_t time_ns);

/// The errors of an IMU, axis by axis.
class ImuErrors {
 public:
  ImuErrors(const ImuSpec& spec, std::uint64_t seed);

  struct Errors {
    Vector3 angular_velocity_radps;
    Vector3 specific_force_mps2;
  };
  [[nodiscard]] Errors Of(std::uint64_t sample) const;

 private:
  /// Three axes of one kind. The figures are those of one sample.
  struct Triad {
    double noise{};
    double walk{};
    double bias{};
    std::uint32_t first_component{};
  };
  [[nodiscard]] Vector3 ErrorsOf(const Triad& triad, std::uint64_t sample) const;

  std::uint64_t seed_;
  Triad gyroscopes_;
  Triad accelerometers_;
};

}  // namespace railcast
