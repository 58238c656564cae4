#pragma once

#include <cmath>
#include <random>
#include <vector>

#include "analysis/compare/cloud_figures.h"
#include "railcast/io/recording.h"

namespace railcast {

struct MadePoint {
  float x{}, y{}, z{};
  float intensity = 0.5F;
  std::uint16_t ring = 0;
  float velocity_mps = 0.0F;
};

/// A frame of one row with these points, as a foreign recording has it.
[[nodiscard]] inline RecordedFrame FrameOf(const std::vector<MadePoint>& points,
                                           std::int64_t stamp_ns = 0) {
  RecordedFrame recorded;
  recorded.frame.stamp_ns = stamp_ns;
  recorded.frame.has_velocity = true;
  recorded.frame.Resize(1, static_cast<std::uint32_t>(points.size()), 1);
  for (std::size_t i = 0; i < points.size(); ++i) {
    recorded.frame.x[i] = points[i].x;
    recorded.frame.y[i] = points[i].y;
    recorded.frame.z[i] = points[i].z;
    recorded.frame.intensity[i] = points[i].intensity;
    recorded.frame.ring[i] = points[i].ring;
    recorded.frame.radial_velocity_mps[i] = points[i].velocity_mps;
    recorded.frame.range_m[i] = std::hypot(points[i].x, points[i].y, points[i].z);
  }
  recorded.fields = {"x", "y", "z", "intensity", "range_m", "ring", "radial_velocity_mps"};
  return recorded;
}

/// 20 x 20 points, 1 m apart, at a height.
[[nodiscard]] inline std::vector<MadePoint> MadePlane(float z_m) {
  std::vector<MadePoint> points;
  for (int i = 0; i < 20; ++i) {
    for (int j = 0; j < 20; ++j) {
      points.push_back({static_cast<float>(i), static_cast<float>(j), z_m});
    }
  }
  return points;
}

/// The points with normal noise in all directions. The seed is fixed, and so are the figures of the
/// tests.
[[nodiscard]] inline std::vector<MadePoint> WithNoise(std::vector<MadePoint> points,
                                                      double sigma_m) {
  std::mt19937 words(1);
  std::normal_distribution<float> noise(0.0F, 1.0F);
  for (MadePoint& point : points) {
    point.x += static_cast<float>(sigma_m) * noise(words);
    point.y += static_cast<float>(sigma_m) * noise(words);
    point.z += static_cast<float>(sigma_m) * noise(words);
  }
  return points;
}

[[nodiscard]] inline ComparedCloud MadeCloud(const std::vector<MadePoint>& points) {
  return CloudOf(FrameOf(points));
}

}  // namespace railcast
