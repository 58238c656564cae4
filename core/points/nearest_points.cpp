#include "core/points/nearest_points.h"

#include <pcl/kdtree/kdtree_flann.h>
#include <pcl/point_types.h>
#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>
// Debian compiles PCL's kd-tree with OpenMP: each search then forms a team of one thread and makes
// a system call, which takes longer than the search. Here, without OpenMP, FLANN's searches are
// instantiated for the whole program.
#include <pcl/kdtree/impl/kdtree_flann.hpp>

#include <cmath>
#include <utility>

#include "core/base/error.h"

namespace railcast {
namespace {

pcl::PointXYZ PointAt(const Eigen::Vector3f& place_m) {
  return {place_m.x(), place_m.y(), place_m.z()};
}

pcl::PointCloud<pcl::PointXYZ>::Ptr CloudOf(const std::vector<Eigen::Vector3f>& points_m) {
  const auto cloud = std::make_shared<pcl::PointCloud<pcl::PointXYZ>>();
  cloud->reserve(points_m.size());
  for (const Eigen::Vector3f& point_m : points_m) cloud->push_back(PointAt(point_m));
  return cloud;
}

}  // namespace

struct NearestSearch::Tree {
  explicit Tree(std::vector<Eigen::Vector3f> given_m) : points_m(std::move(given_m)) {
    index.setInputCloud(CloudOf(points_m));
  }

  std::vector<Eigen::Vector3f> points_m;
  pcl::KdTreeFLANN<pcl::PointXYZ> index;  // Nearest first.
};

NearestSearch::NearestSearch(std::vector<Eigen::Vector3f> points_m) {
  Check(!points_m.empty(), "a cloud to be searched has points");
  tree_ = std::make_unique<const Tree>(std::move(points_m));
}

NearestSearch::~NearestSearch() = default;
NearestSearch::NearestSearch(NearestSearch&&) noexcept = default;
NearestSearch& NearestSearch::operator=(NearestSearch&&) noexcept = default;

const std::vector<Eigen::Vector3f>& NearestSearch::points_m() const {
  return tree_->points_m;
}

NearestPoints NearestSearch::Of(const std::vector<Eigen::Vector3f>& queries_m) const {
  constexpr std::size_t kGrain = 1024;
  NearestPoints nearest;
  nearest.distance_m.resize(queries_m.size());
  nearest.index.resize(queries_m.size());
  tbb::parallel_for(tbb::blocked_range<std::size_t>(0, queries_m.size(), kGrain),
                    [&](const tbb::blocked_range<std::size_t>& range) {
                      pcl::Indices found;
                      std::vector<float> squares_m2;
                      for (std::size_t i = range.begin(); i != range.end(); ++i) {
                        tree_->index.nearestKSearch(PointAt(queries_m[i]), 1, found, squares_m2);
                        nearest.index[i] = static_cast<std::uint32_t>(found.front());
                        nearest.distance_m[i] = std::sqrt(squares_m2.front());
                      }
                    });
  return nearest;
}

void NearestSearch::FindNearest(const Eigen::Vector3f& place_m,
                                std::size_t num,
                                std::vector<std::uint32_t>& found) const {
  pcl::Indices indices;
  std::vector<float> squares_m2;
  tree_->index.nearestKSearch(PointAt(place_m), static_cast<unsigned>(num), indices, squares_m2);
  found.assign(indices.begin(), indices.end());
}

void NearestSearch::FindWithin(const Eigen::Vector3f& place_m,
                               float radius_m,
                               std::vector<std::uint32_t>& found) const {
  pcl::Indices indices;
  std::vector<float> squares_m2;
  tree_->index.radiusSearch(PointAt(place_m), static_cast<double>(radius_m), indices, squares_m2);
  found.assign(indices.begin(), indices.end());
}

}  // namespace railcast
