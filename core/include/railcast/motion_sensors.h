#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <limits>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "railcast/lidar.h"
#include "railcast/rail_world.h"
#include "railcast/simulator.h"
#include "railcast/transform.h"

namespace railcast {

/// An inertial measurement unit: three gyroscopes and three accelerometers, in the axes of its
/// mount.
///
/// Each axis measures the exact value plus a bias plus white noise. The bias begins at a value that
/// is drawn once and from there on walks at random. The standard deviation of the noise of a sample
/// is noise density x sqrt(rate_hz), and that of the bias's step from one sample to the next is
/// random walk / sqrt(rate_hz).
struct ImuSpec {
  std::string name = "imu";
  double rate_hz = 100.0;
  MountSpec mount{};
  double gyroscope_noise_density_degps_per_sqrthz = 0.0;
  double gyroscope_random_walk_degps2_per_sqrthz = 0.0;
  double gyroscope_bias_degps = 0.0;  ///< Standard deviation at time 0.
  double accelerometer_noise_density_mps2_per_sqrthz = 0.0;
  double accelerometer_random_walk_mps3_per_sqrthz = 0.0;
  double accelerometer_bias_mps2 = 0.0;  ///< Standard deviation at time 0.

  bool operator==(const ImuSpec&) const = default;
};

/// A receiver of satellite navigation. Of its mounting, only the antenna's place matters.
///
/// It has a fix where enough of the sky is free. The errors of its position are Gauss-Markov
/// processes, those of its velocity white noise; both grow with 1 / sqrt(sky share), as fewer
/// satellites are averaged.
struct GnssSpec {
  std::string name = "gnss";
  double rate_hz = 1.0;
  std::array<double, 3> antenna_m{0.0, 0.0, 4.0};  ///< In the vehicle frame.
  double horizontal_noise_m = 0.0;  ///< Standard deviation of x and of y under a free sky.
  double vertical_noise_m = 0.0;
  double velocity_noise_mps = 0.0;    ///< Standard deviation of each component under a free sky.
  double correlation_time_s = 100.0;  ///< Time in which position errors decorrelate to 1/e.
  double elevation_mask_deg = 10.0;   ///< Sky below this elevation does not count.
  double least_sky_share = 0.3;       ///< Free share of the sky above the mask that a fix needs.

  bool operator==(const GnssSpec&) const = default;
};

/// A wheel encoder: pulses of a wheel that may be worn and slip.
struct OdometerSpec {
  std::string name = "odometer";
  double rate_hz = 50.0;
  double wheel_diameter_m = 0.92;                 ///< As the odometer assumes it.
  std::optional<double> true_wheel_diameter_m{};  ///< Absent = as assumed.
  std::uint32_t pulses_per_revolution = 100;
  double traction_slip_share = 0.0;  ///< Share by which the wheel turns faster in traction.
  double braking_slip_share = 0.0;   ///< Share by which the wheel turns slower in braking.
  /// Coefficient of adhesion. If given, the wheel also creeps in proportion to the force at its rim
  /// (the linear part of Carter 1926), by the share creep_at_adhesion at the adhesion limit.
  std::optional<double> adhesion{};
  double creep_at_adhesion = 0.01;

  bool operator==(const OdometerSpec&) const = default;
};

/// The motion sensors of the vehicle. No two may have the same name.
struct MotionSensorsSpec {
  std::vector<ImuSpec> imus{};
  std::vector<GnssSpec> gnss{};
  std::vector<OdometerSpec> odometers{};

  bool operator==(const MotionSensorsSpec&) const = default;
};

/// What an IMU measures at an instant, in its own axes.
struct ImuSample {
  std::int64_t time_ns{};
  Vector3 angular_velocity_radps = Vector3::Zero();
  /// Acceleration minus that of gravity: (0, 0, 9.80665) at rest on level track.
  Vector3 specific_force_mps2 = Vector3::Zero();
  Vector3 true_angular_velocity_radps = Vector3::Zero();  ///< Without bias and noise.
  Vector3 true_specific_force_mps2 = Vector3::Zero();     ///< Without bias and noise.
};

/// What a GNSS receiver measures at an instant. Without a fix, the measured values are NaN. Vectors
/// are in the world frame: x to the east, y to the north of its map, z up.
struct GnssSample {
  std::int64_t time_ns{};
  bool has_fix = false;
  double sky_share{};  ///< Free share of the sky above the elevation mask, 0 to 1.
  /// Position of the antenna.
  Vector3 position_m = Vector3::Constant(std::numeric_limits<double>::quiet_NaN());
  /// The same place on the Earth (WGS 84); NaN where the alignment has no map.
  double longitude_deg = std::numeric_limits<double>::quiet_NaN();
  double latitude_deg = std::numeric_limits<double>::quiet_NaN();
  Vector3 velocity_mps = Vector3::Constant(std::numeric_limits<double>::quiet_NaN());
  /// Standard deviations of the errors of this sample's position along x, y and z.
  Vector3 position_sigma_m = Vector3::Constant(std::numeric_limits<double>::quiet_NaN());
  double velocity_sigma_mps = std::numeric_limits<double>::quiet_NaN();
  Vector3 true_position_m = Vector3::Zero();
  Vector3 true_velocity_mps = Vector3::Zero();

  /// Height that goes with longitude and latitude, above the datum of the alignment's heights.
  [[nodiscard]] double height_m() const { return position_m.z(); }
};

/// What an odometer measures at an instant. All of it is positive in the direction of travel.
struct OdometerSample {
  std::int64_t time_ns{};
  std::int64_t pulses{};     ///< Since time 0.
  double distance_m{};       ///< Distance of these pulses at the assumed wheel diameter.
  double speed_mps{};        ///< From the pulses since the previous sample.
  double true_distance_m{};  ///< Along the track, since time 0.
  double true_speed_mps{};
};

// `ForEachColumn(sample, visit)` calls `visit(name, unit, value)` for every quantity of a sample,
// in the order in which files store them. Files, the Python module and the documentation use this
// one table. Values are numbers or vectors.

template <typename Visitor>
void ForEachColumn(const ImuSample& sample, Visitor&& visit) {
  visit("time", "ns", sample.time_ns);
  visit("angular_velocity", "radps", sample.angular_velocity_radps);
  visit("specific_force", "mps2", sample.specific_force_mps2);
  visit("true_angular_velocity", "radps", sample.true_angular_velocity_radps);
  visit("true_specific_force", "mps2", sample.true_specific_force_mps2);
}

template <typename Visitor>
void ForEachColumn(const GnssSample& sample, Visitor&& visit) {
  visit("time", "ns", sample.time_ns);
  visit("has_fix", "", sample.has_fix);
  visit("sky_share", "", sample.sky_share);
  visit("longitude", "deg", sample.longitude_deg);
  visit("latitude", "deg", sample.latitude_deg);
  visit("position", "m", sample.position_m);
  visit("velocity", "mps", sample.velocity_mps);
  visit("position_sigma", "m", sample.position_sigma_m);
  visit("velocity_sigma", "mps", sample.velocity_sigma_mps);
  visit("true_position", "m", sample.true_position_m);
  visit("true_velocity", "mps", sample.true_velocity_mps);
}

template <typename Visitor>
void ForEachColumn(const OdometerSample& sample, Visitor&& visit) {
  visit("time", "ns", sample.time_ns);
  visit("pulses", "", sample.pulses);
  visit("distance", "m", sample.distance_m);
  visit("speed", "mps", sample.speed_mps);
  visit("true_distance", "m", sample.true_distance_m);
  visit("true_speed", "mps", sample.true_speed_mps);
}

/// The samples of a stretch of time: a list for each sensor, in the order of MotionSensorsSpec.
struct MotionSamples {
  std::vector<std::vector<ImuSample>> imus;
  std::vector<std::vector<GnssSample>> gnss;
  std::vector<std::vector<OdometerSample>> odometers;
};

/// Samples the motion sensors of a scenario. A sample depends only on its index, on the seed and on
/// what commands have changed until its time, not on which samples were made before. Immutable,
/// thread-safe, cheap to copy.
///
///     const auto sensors = MakeMotionSensors(scenario, *world);
///     const MotionSamples samples = sensors->Sample(*simulator, frame_index);
class MotionSensors {
 public:
  /// @param vehicle_from_imus The mounts of the IMUs, in the order of spec.imus.
  /// @param world The world as it is at time 0.
  /// @param map The map of the world's alignment, if it has one.
  /// @param seed_of Returns the key of a sensor's random draws, given the sensor's name.
  MotionSensors(const MotionSensorsSpec& spec,
                const std::vector<Transform>& vehicle_from_imus,
                const RailWorld& world,
                const std::optional<MapSpec>& map,
                const std::function<std::uint64_t(const std::string& name)>& seed_of);

  [[nodiscard]] const MotionSensorsSpec& spec() const;

  /// Makes the samples in the time of a begun frame: from its stamp on and before the next one's.
  /// @param simulator The one that began the frame, still with the world of the frame.
  [[nodiscard]] MotionSamples Sample(Simulator& simulator, BegunFrame& begun) const;
  /// The overload for a frame that was not begun.
  [[nodiscard]] MotionSamples Sample(Simulator& simulator, std::uint32_t frame_index) const;

 private:
  struct Parts;
  std::shared_ptr<const Parts> parts_;
};

}  // namespace railcast
