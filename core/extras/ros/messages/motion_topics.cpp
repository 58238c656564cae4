#include "core/extras/ros/messages/motion_topics.h"

#include <array>

#include "core/base/units.h"
#include "core/extras/ros/messages/frame_topics.h"
#include "core/extras/ros/messages/point_layout.h"
#include "core/extras/ros/messages/scene_topics.h"

namespace railcast::ros {
namespace {

// A covariance matrix without covariances.
std::array<double, 9> Diagonal(const Vector3& variances) {
  return {variances.x(), 0.0, 0.0, 0.0, variances.y(), 0.0, 0.0, 0.0, variances.z()};
}

// The variance of the white noise of samples, of all three axes.
std::array<double, 9> NoiseVariance(double density, double rate_hz) {
  return Diagonal(Vector3::Constant(density * density * rate_hz));
}

}  // namespace

Imu ImuMessage(const ImuSample& sample, const ImuSpec& spec) {
  Imu message;
  message.header = {TimeOf(sample.time_ns), RosName(spec.name)};
  message.orientation_covariance[0] = -1.0;
  message.angular_velocity = VectorOf(sample.angular_velocity_radps);
  message.angular_velocity_covariance =
      NoiseVariance(RadFromDeg(spec.gyroscope_noise_density_degps_per_sqrthz), spec.rate_hz);
  message.linear_acceleration = VectorOf(sample.specific_force_mps2);
  message.linear_acceleration_covariance =
      NoiseVariance(spec.accelerometer_noise_density_mps2_per_sqrthz, spec.rate_hz);
  return message;
}

NavSatFix FixMessage(const GnssSample& sample, const GnssSpec& spec) {
  NavSatFix message;
  message.header = {TimeOf(sample.time_ns), RosName(spec.name)};
  message.status = {sample.has_fix ? NavSatStatus::kFix : NavSatStatus::kNoFix, NavSatStatus::kGps};
  message.latitude = sample.latitude_deg;
  message.longitude = sample.longitude_deg;
  message.altitude = sample.height_m();
  if (!sample.has_fix) return message;
  message.position_covariance = Diagonal(sample.position_sigma_m.cwiseAbs2());
  message.position_covariance_type = NavSatFix::kCovarianceDiagonalKnown;
  return message;
}

TwistStamped SpeedMessage(const OdometerSample& sample) {
  TwistStamped message;
  message.header = {TimeOf(sample.time_ns), "base_link"};
  message.twist.linear.x = sample.speed_mps;
  return message;
}

}  // namespace railcast::ros
