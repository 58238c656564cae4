#include <algorithm>
#include <cmath>

#include "core/base/error.h"
#include "core/scenario/sensors.h"
#include "railcast/scenario.h"

namespace railcast {

std::optional<std::uint32_t> FramesFromImageToImage(const CameraSpec& camera, double scan_rate_hz) {
  if (!camera.rate_hz) return 1;
  // Rates are decimal fractions, whose quotient may be rounded.
  constexpr double kRounding = 1e-9;
  constexpr double kMostFrames = 1e6;
  const double num_frames = scan_rate_hz / *camera.rate_hz;
  const double whole = std::round(num_frames);
  if (!(whole >= 1.0 && whole <= kMostFrames && std::abs(num_frames / whole - 1.0) <= kRounding)) {
    return std::nullopt;
  }
  return static_cast<std::uint32_t>(whole);
}

bool HasFramesForImages(const ScenarioSpec& spec) {
  const std::vector<SensorPlace> sensors = SensorsOf(spec);
  return std::all_of(sensors.begin(), sensors.end(), [&](const SensorPlace& sensor) {
    return FramesFromImageToImage(*spec.camera, sensor.lidar.scan.rate_hz).has_value();
  });
}

std::uint32_t FramesPerImage(const ScenarioSpec& spec) {
  const auto num_frames = FramesFromImageToImage(*spec.camera, spec.lidar.scan.rate_hz);
  Check(num_frames.has_value(), "the scenario's reader checks the rates");
  return *num_frames;
}

Transform VehicleFromCamera(const ScenarioSpec& spec) {
  Eigen::Matrix3d body_from_optical;  // Body: x forward, y left, z up.
  body_from_optical << 0, 0, 1, -1, 0, 0, 0, -1, 0;
  return VehicleFromSensor(spec.camera->mount.value_or(spec.lidar.mount)) *
         MakeTransform(body_from_optical, Vector3::Zero());
}

std::optional<Camera> MakeCamera(const ScenarioSpec& spec) {
  if (!spec.camera) return std::nullopt;
  return Camera(*spec.camera, VehicleFromCamera(spec), MaterialLibrary(spec.materials));
}

}  // namespace railcast
