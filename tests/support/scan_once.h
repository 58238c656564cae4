#pragma once

#include <memory>
#include <utility>

#include "core/base/transform.h"
#include "core/frame/frame.h"
#include "core/scan/scan_pattern.h"
#include "core/scene/material.h"
#include "core/simulate/simulator.h"

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

/// A firing's direction in the sensor frame, of unit length in double: float32 is to 6e-8 only.
[[nodiscard]] inline Vector3 DirectionOf(const ScanPattern& pattern, std::size_t firing) {
  return Eigen::Vector3f(pattern.direction_x[firing], pattern.direction_y[firing],
                         pattern.direction_z[firing])
      .cast<double>()
      .normalized();
}

/// One frame of a world. Rung geometry unless the spec says otherwise.
[[nodiscard]] inline Frame ScanOnce(std::shared_ptr<const World> world,
                                    const ScanPattern& pattern,
                                    const SimulatorSpec& spec = {},
                                    std::uint32_t frame_index = 0,
                                    int num_threads = 0) {
  Simulator simulator(std::move(world), pattern, TestMaterials(), spec, num_threads);
  Frame frame;
  simulator.Scan(frame_index, frame);
  return frame;
}

}  // namespace railcast
