#pragma once

#include <pcl/kdtree/kdtree_flann.h>
#include <pcl/point_cloud.h>
#include <pcl/point_types.h>

#include <cstdint>
#include <vector>

namespace railcast {

/// For every point of one cloud, the nearest point of another cloud.
struct NearestPoints {
  std::vector<float> distance_m;
  std::vector<std::uint32_t> index;  ///< Index of the nearest point in the other cloud.
};

/// Finds the exact nearest points of a cloud with PCL's kd-tree.
class NearestSearch {
 public:
  /// @pre `cloud` is not empty, and all its coordinates are finite.
  explicit NearestSearch(const pcl::PointCloud<pcl::PointXYZ>::ConstPtr& cloud);

  /// Searches in parallel; the result does not depend on the number of threads.
  [[nodiscard]] NearestPoints Of(const pcl::PointCloud<pcl::PointXYZ>& queries) const;

 private:
  pcl::KdTreeFLANN<pcl::PointXYZ> tree_;
};

}  // namespace railcast
