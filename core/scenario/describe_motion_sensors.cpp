#include "core/scenario/descriptions.h"

#include <set>
#include <string>

#include "railcast/camera.h"
#include "railcast/motion_sensors.h"

namespace railcast {

namespace {

void DescribeMotionSensorName(Archive& a, std::string& name) {
  a.Optional("name", name, "Unique among the motion sensors; lower-case letters, digits and _.");
  a.Ensure({"name"}, IsCameraName(name),
           "must consist of 1 to 64 lower-case letters, digits and _");
}

/// Whether all names differ; the same name twice among the sensors of one kind counts, too.
[[nodiscard]] bool HaveDifferentNames(const MotionSensorsSpec& spec) {
  std::set<std::string> names;
  const auto add = [&](const auto& sensors) {
    for (const auto& sensor : sensors) names.insert(sensor.name);
  };
  add(spec.imus);
  add(spec.gnss);
  add(spec.odometers);
  return names.size() == spec.imus.size() + spec.gnss.size() + spec.odometers.size();
}

}  // namespace

void Describe(Archive& a, ImuSpec& s) {
  DescribeMotionSensorName(a, s.name);
  a.Optional("rate_hz", s.rate_hz, "Samples per second.", PositiveUpTo(10'000));
  a.Optional("mount", s.mount, "Where it is on the vehicle, and its axes.");
  a.Optional("gyroscope_noise_density_degps_per_sqrthz", s.gyroscope_noise_density_degps_per_sqrthz,
             "White noise of the angular velocity, in deg/s/sqrt(Hz): the angular random walk in "
             "deg/sqrt(h) divided by 60.",
             Within(0, 1000));
  a.Optional("gyroscope_random_walk_degps2_per_sqrthz", s.gyroscope_random_walk_degps2_per_sqrthz,
             "Random walk of the bias of the angular velocity, in deg/s^2/sqrt(Hz).",
             Within(0, 1000));
  a.Optional("gyroscope_bias_degps", s.gyroscope_bias_degps,
             "Standard deviation of this bias at time 0.", Within(0, 1000));
  a.Optional("accelerometer_noise_density_mps2_per_sqrthz",
             s.accelerometer_noise_density_mps2_per_sqrthz,
             "White noise of the specific force, in m/s^2/sqrt(Hz).", Within(0, 1000));
  a.Optional("accelerometer_random_walk_mps3_per_sqrthz",
             s.accelerometer_random_walk_mps3_per_sqrthz,
             "Random walk of the bias of the specific force, in m/s^3/sqrt(Hz).", Within(0, 1000));
  a.Optional("accelerometer_bias_mps2", s.accelerometer_bias_mps2,
             "Standard deviation of this bias at time 0.", Within(0, 1000));
}

void Describe(Archive& a, GnssSpec& s) {
  DescribeMotionSensorName(a, s.name);
  a.Optional("rate_hz", s.rate_hz, "Samples per second.", PositiveUpTo(10'000));
  a.Optional("antenna_m", s.antenna_m, "In the vehicle frame: forward, left, up.", Within(-50, 50));
  a.Optional("horizontal_noise_m", s.horizontal_noise_m,
             "Standard deviation of the easting and of the northing under a free sky.",
             Within(0, 1000));
  a.Optional("vertical_noise_m", s.vertical_noise_m,
             "Standard deviation of the height under a free sky.", Within(0, 1000));
  a.Optional("velocity_noise_mps", s.velocity_noise_mps,
             "Standard deviation of each component of the velocity under a free sky.",
             Within(0, 1000));
  a.Optional("correlation_time_s", s.correlation_time_s,
             "In which the correlation of the errors of position falls to 1/e.", Within(1e-3, 1e6));
  a.Optional("elevation_mask_deg", s.elevation_mask_deg,
             "Above the horizon; satellites below are not used.", Within(0, 80));
  a.Optional("least_sky_share", s.least_sky_share,
             "Share of the sky above the mask that must be free for a fix.", Within(0, 1));
}

void Describe(Archive& a, OdometerSpec& s) {
  DescribeMotionSensorName(a, s.name);
  a.Optional("rate_hz", s.rate_hz, "Samples per second.", PositiveUpTo(10'000));
  a.Optional("wheel_diameter_m", s.wheel_diameter_m, "As the odometer assumes it.", Within(0.1, 3));
  a.Optional("true_wheel_diameter_m", s.true_wheel_diameter_m,
             "As it is, with its wear; absent = as assumed.", Within(0.1, 3));
  a.Optional("pulses_per_revolution", s.pulses_per_revolution,
             "Pulses per revolution of the wheel.", Within(1, 1'000'000));
  a.Optional("traction_slip_share", s.traction_slip_share,
             "By how much more the wheel turns than it rolls while the speed rises.", Within(0, 1));
  a.Optional("braking_slip_share", s.braking_slip_share,
             "By how much less the wheel turns than it rolls while the speed falls.", Within(0, 1));
  a.Optional("adhesion", s.adhesion,
             "Coefficient of adhesion, on which creep depends; absent = there is no creep.",
             Within(0.01, 1));
  a.Optional("creep_at_adhesion", s.creep_at_adhesion,
             "Share by which the wheel creeps where its force is all that adhesion allows.",
             Within(0, 1));
}

void Describe(Archive& a, MotionSensorsSpec& s) {
  a.Optional("imus", s.imus, "Inertial measurement units.");
  a.Optional("gnss", s.gnss, "Receivers of satellite navigation.");
  a.Optional("odometers", s.odometers, "Pulses of wheels.");
  a.Ensure({"", "imus", "gnss", "odometers"}, HaveDifferentNames(s),
           "must have a different name for each sensor");
}

}  // namespace railcast
