#pragma once

#include <memory>
#include <utility>

#include "railcast/frame.h"
#include "railcast/lidar.h"
#include "railcast/material.h"
#include "railcast/simulator.h"
#include "railcast/transform.h"

namespace railcast {

/// Materials 1 to 3 of test scenes: reflectivity 0.1, 0.5 and 1.
[[nodiscard]] inline MaterialLibrary TestMaterials() {
  return MaterialLibrary({{"dark", 0.1}, {"grey", 0.5}, {"white", 1.0}});
}

[[nodiscard]] inline ScanPattern MakeRaster(double horizontal_fov_deg,
                                            double vertical_fov_deg,
                                            double angular_resolution_deg) {
  return BuildScanPattern(
      {.rate_hz = 10.0,
       .pattern = RasterSpec{.horizontal_fov_deg = horizontal_fov_deg,
                             .vertical_fov_deg = vertical_fov_deg,
                             .angular_resolution_deg = angular_resolution_deg}});
}

/// Returns a firing's direction in the sensor frame, normalised in double, because float32 is of
/// unit length only to 6e-8.
[[nodiscard]] inline Vector3 DirectionOf(const ScanPattern& pattern, std::size_t firing) {
  return Eigen::Vector3f(pattern.direction_x[firing], pattern.direction_y[firing],
                         pattern.direction_z[firing])
      .cast<double>()
      .normalized();
}

/// The point of a slot in the frame's coordinates.
[[nodiscard]] inline Vector3 PointAt(const Frame& frame, std::size_t slot) {
  return Eigen::Vector3f(frame.x[slot], frame.y[slot], frame.z[slot]).cast<double>();
}

/// Scans one frame with a simulator, which may be a temporary one.
template <typename Scanner>
[[nodiscard]] Frame FrameBy(Scanner&& simulator, std::uint32_t frame_index = 0) {
  Frame frame;
  simulator.Scan(frame_index, frame);
  return frame;
}

/// Scans one frame of a world, with the rung geometry unless the spec says otherwise.
[[nodiscard]] inline Frame ScanOnce(std::shared_ptr<const World> world,
                                    const ScanPattern& pattern,
                                    const SimulatorSpec& spec = {},
                                    std::uint32_t frame_index = 0,
                                    int num_threads = 0) {
  return FrameBy(Simulator(std::move(world), pattern, TestMaterials(), spec, num_threads),
                 frame_index);
}

}  // namespace railcast
