#include "core/io/cloud/nearest_points.h"

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <cmath>

#include "core/base/error.h"

namespace railcast {

NearestSearch::NearestSearch(const pcl::PointCloud<pcl::PointXYZ>::ConstPtr& cloud) {
  Check(!cloud->empty(), "a cloud to be searched has points");
  tree_.setInputCloud(cloud);
}

NearestPoints NearestSearch::Of(const pcl::PointCloud<pcl::PointXYZ>& queries) const {
  constexpr std::size_t kGrain = 1024;
  NearestPoints nearest;
  nearest.distance_m.resize(queries.size());
  nearest.index.resize(queries.size());
  tbb::parallel_for(tbb::blocked_range<std::size_t>(0, queries.size(), kGrain),
                    [&](const tbb::blocked_range<std::size_t>& range) {
                      pcl::Indices index(1);
                      std::vector<float> square_m2(1);
                      for (std::size_t i = range.begin(); i != range.end(); ++i) {
                        tree_.nearestKSearch(queries[i], 1, index, square_m2);
                        nearest.distance_m[i] = std::sqrt(square_m2[0]);
                        nearest.index[i] = static_cast<std::uint32_t>(index[0]);
                      }
                    });
  return nearest;
}

}  // namespace railcast
