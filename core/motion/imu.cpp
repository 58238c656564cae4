#include "core/motion/imu.h"

#include <cmath>

#include "core/base/units.h"

namespace railcast {
namespace {

/// Kinds of sequences of an axis.
constexpr std::uint32_t kNumAxes = 3;
/// The draw of the bias at time 0 comes from the sequences behind those of both triads.
constexpr std::uint32_t kBiasComponents = 2 * kNumAxes;

}  // namespace

ImuSample TrueImuSample(const RigidMotion& vehicle,
                        const Transform& vehicle_from_imu,
                        std::int64_t time_ns) {
  const Eigen::Matrix3d imu_from_world =
      (vehicle.world_from_body.linear() * vehicle_from_imu.linear()).transpose();
  const Vector3 acceleration_mps2 = vehicle.AccelerationOf_mps2(vehicle_from_imu.translation());
  ImuSample sample;
  sample.time_ns = time_ns;
  sample.true_angular_velocity_radps = imu_from_world * vehicle.angular_velocity_radps;
  sample.true_specific_force_mps2 =
      imu_from_world * (acceleration_mps2 + kGravity_mps2 * Vector3::UnitZ());
  return sample;
}

ImuErrors::ImuErrors(const ImuSpec& spec, std::uint64_t seed)
    : seed_(seed),
      gyroscopes_{
          RadFromDeg(spec.gyroscope_noise_density_degps_per_sqrthz) * std::sqrt(spec.rate_hz),
          RadFromDeg(spec.gyroscope_random_walk_degps2_per_sqrthz) / std::sqrt(spec.rate_hz),
          RadFromDeg(spec.gyroscope_bias_degps), 0},
      accelerometers_{spec.accelerometer_noise_density_mps2_per_sqrthz * std::sqrt(spec.rate_hz),
                      spec.accelerometer_random_walk_mps3_per_sqrthz / std::sqrt(spec.rate_hz),
                      spec.accelerometer_bias_mps2, kNumAxes} {}

Vector3 ImuErrors::ErrorsOf(const Triad& triad, std::uint64_t sample) const {
  Vector3 errors = Vector3::Zero();
  for (std::uint32_t axis = 0; axis < kNumAxes; ++axis) {
    const SequenceKey key{seed_, triad.first_component + axis};
    double& error = errors(axis);
    if (triad.noise > 0.0) error += triad.noise * WhiteNoise(key, sample);
    if (triad.walk > 0.0) error += triad.walk * MarkovSequence::Walk(key).At(sample);
    if (triad.bias > 0.0) {
      error += triad.bias * WhiteNoise({seed_, key.component + kBiasComponents}, 0);
    }
  }
  return errors;
}

ImuErrors::Errors ImuErrors::Of(std::uint64_t sample) const {
  return {ErrorsOf(gyroscopes_, sample), ErrorsOf(accelerometers_, sample)};
}

}  // namespace railcast
