#include <algorithm>

#include "core/scenario/sensors.h"
#include "railcast/scenario.h"

namespace railcast {
namespace {

double GreatestRate_hz(const MotionSensorsSpec& spec) {
  double greatest_hz = 0.0;
  const auto take = [&](const auto& sensors) {
    for (const auto& sensor : sensors) greatest_hz = std::max(greatest_hz, sensor.rate_hz);
  };
  take(spec.imus);
  take(spec.gnss);
  take(spec.odometers);
  return greatest_hz;
}

}  // namespace

bool HasFewSamplesInFrame(const MotionSensorsSpec& motion_sensors, const ScenarioSpec& spec) {
  const double greatest_hz = GreatestRate_hz(motion_sensors);
  return std::ranges::all_of(SensorsOf(spec), [&](const SensorPlace& sensor) {
    return greatest_hz <= kMostSamplesInFrame * sensor.lidar.scan.rate_hz;
  });
}

std::optional<MotionSensors> MakeMotionSensors(const ScenarioSpec& spec, const RailWorld& world) {
  if (!spec.motion_sensors) return std::nullopt;
  std::vector<Transform> vehicle_from_imus;
  for (const ImuSpec& imu : spec.motion_sensors->imus) {
    vehicle_from_imus.push_back(VehicleFromSensor(imu.mount));
  }
  return MotionSensors(*spec.motion_sensors, vehicle_from_imus, world, spec.world.alignment.map,
                       [&](const std::string& name) { return SensorSeed(spec.seed, name); });
}

}  // namespace railcast
