#pragma once

#include <pcl/kdtree/kdtree_flann.h>
#include <pcl/point_cloud.h>
#include <pcl/point_types.h>

#include <cstdint>
#include <vector>

namespace railcast {

/// Of every point of one cloud, the nearest of another.
struct NearestPoints {
  std::vector<float> distance_m;
  std::vector<std::uint32_t> index;  ///< Of the nearest in the other cloud.
};

/// Finds nearest points of a cloud, exactly, by PCL's kd-tree.
class NearestSearch {
 public:
  /// @pre `cloud` has points, all of numbers.
  explicit NearestSearch(const pcl::PointCloud<pcl::PointXYZ>::ConstPtr& cloud);

  /// In parallel; the same at any number of threads.
  [[nodiscard]] NearestPoints Of(const pcl::PointCloud<pcl::PointXYZ>& queries) const;

 private:
  pcl::KdTreeFLANN<pcl::PointXYZ> tree_;
};

}  // namespace railcast
