#pragma once

#include <pcl/point_cloud.h>
#include <pcl/point_types.h>

#include <cmath>
#include <cstdint>
#include <vector>

#include "railcast/io/recording.h"

namespace railcast {

/// The points of a frame, of all its returns, in the sensor frame; points that are not finite are
/// left out.
struct ComparedCloud {
  pcl::PointCloud<pcl::PointXYZ>::Ptr points{new pcl::PointCloud<pcl::PointXYZ>()};
  std::vector<float> range_m;        ///< Distance from the sensor's origin.
  std::vector<float> intensity;      ///< NaN where the intensity is not finite; empty if unknown.
  std::vector<std::uint16_t> rings;  ///< Empty if unknown.

  [[nodiscard]] std::size_t size() const { return points->size(); }
};

[[nodiscard]] inline ComparedCloud CloudOf(const RecordedFrame& recorded) {
  const Frame& frame = recorded.frame;
  ComparedCloud cloud;
  for (std::size_t slot = 0; slot < frame.num_slots(); ++slot) {
    const float x = frame.x[slot], y = frame.y[slot], z = frame.z[slot];
    if (!std::isfinite(x) || !std::isfinite(y) || !std::isfinite(z)) continue;
    cloud.points->push_back({x, y, z});
    cloud.range_m.push_back(std::hypot(x, y, z));
    if (recorded.Has("intensity")) cloud.intensity.push_back(frame.intensity[slot]);
    if (recorded.Has("ring")) cloud.rings.push_back(frame.ring[slot]);
  }
  return cloud;
}

}  // namespace railcast
