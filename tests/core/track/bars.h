#pragma once

#include <cmath>
#include <limits>
#include <numbers>
#include <random>
#include <vector>

#include "railcast/transform.h"

namespace railcast {

/// Something long beside the sensor, parallel to its x axis, on level ground.
struct Bar {
  double left_m{};    ///< Of its middle from the sensor.
  double width_m{};   ///< Or diameter.
  double height_m{};  ///< Of its top above the ground.
  bool is_round{};    ///< Lies with its axis half a diameter below its top; else it is a box.
};

/// The range at which a beam from `height_m` above level ground meets the ground or a bar.
inline double RangeToBars_m(const Vector3& beam, double height_m, const std::vector<Bar>& bars) {
  double nearest_m =
      beam.z() < 0.0 ? -height_m / beam.z() : std::numeric_limits<double>::infinity();
  for (const Bar& bar : bars) {
    const double top_m = bar.height_m - height_m;
    if (bar.is_round) {
      const double radius_m = 0.5 * bar.width_m;
      const double z_m = top_m - radius_m;
      const double a = beam.y() * beam.y() + beam.z() * beam.z();
      const double b = beam.y() * bar.left_m + beam.z() * z_m;
      const double under = b * b - a * (bar.left_m * bar.left_m + z_m * z_m - radius_m * radius_m);
      if (under >= 0.0 && b > std::sqrt(under))
        nearest_m = std::min(nearest_m, (b - std::sqrt(under)) / a);
      continue;
    }
    // The slab of its width and that of its height.
    const double left_m = (bar.left_m - 0.5 * bar.width_m) / beam.y();
    const double right_m = (bar.left_m + 0.5 * bar.width_m) / beam.y();
    const double up_m = top_m / beam.z();
    const double down_m = -height_m / beam.z();
    const double in_m = std::max(std::min(left_m, right_m), std::min(up_m, down_m));
    const double out_m = std::min(std::max(left_m, right_m), std::max(up_m, down_m));
    if (in_m > 0.0 && in_m < out_m) nearest_m = std::min(nearest_m, in_m);
  }
  return nearest_m;
}

/// The points of a sensor with 64 rings from -45 to 10 degrees, every 0.2 degrees, with 5 mm of
/// noise in range.
inline std::vector<Eigen::Vector3f> PointsOfBars(double height_m, const std::vector<Bar>& bars) {
  constexpr double kDeg_rad = std::numbers::pi / 180.0;
  constexpr double kMost_m = 60.0;
  std::mt19937 random(1);
  std::normal_distribution<double> noise_m(0.0, 0.005);
  std::vector<Eigen::Vector3f> points_m;
  for (int ring = 0; ring < 64; ++ring) {
    const double elevation_rad = kDeg_rad * (-45.0 + ring * 55.0 / 63.0 + 1e-4);
    for (int column = 0; column < 1800; ++column) {
      const double azimuth_rad = kDeg_rad * (0.2 * column + 1e-4);
      const Vector3 beam(std::cos(elevation_rad) * std::cos(azimuth_rad),
                         std::cos(elevation_rad) * std::sin(azimuth_rad), std::sin(elevation_rad));
      const double range_m = RangeToBars_m(beam, height_m, bars);
      if (range_m < kMost_m) points_m.push_back(((range_m + noise_m(random)) * beam).cast<float>());
    }
  }
  return points_m;
}

}  // namespace railcast
