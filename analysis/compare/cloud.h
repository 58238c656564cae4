#pragma once

#include <pcl/point_cloud.h>
#include <pcl/point_types.h>

#include <cstdint>
#include <vector>

#include "core/io/recording/recording.h"

namespace railcast {

/// The points of a frame, of all its returns, in the sensor's axes; what is no number is left out.
struct ComparedCloud {
  pcl::PointCloud<pcl::PointXYZ>::Ptr points{new pcl::PointCloud<pcl::PointXYZ>()};
  std::vector<float> range_m;        ///< From the origin.
  std::vector<float> intensity;      ///< NaN where it is no number; empty: not known.
  std::vector<std::uint16_t> rings;  ///< Empty: not known.

  [[nodiscard]] std::size_t size() const { return points->size(); }
};

[[nodiscard]] ComparedCloud CloudOf(const RecordedFrame& recorded);

}  // namespace railcast
