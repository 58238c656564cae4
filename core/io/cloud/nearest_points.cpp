#include "core/io/cloud/nearest_points.h"

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <nanoflann.hpp>
#include <utility>

#include "core/base/error.h"

namespace railcast {
namespace {

/// Points as nanoflann reads them.
struct TreePoints {
  std::vector<Eigen::Vector3f> points_m;

  // The names are nanoflann's.
  [[nodiscard]] std::size_t kdtree_get_point_count() const { return points_m.size(); }
  [[nodiscard]] float kdtree_get_pt(std::size_t index, std::size_t axis) const {
    return points_m[index][static_cast<Eigen::Index>(axis)];
  }
  template <class Box>
  [[nodiscard]] bool kdtree_get_bbox(Box& /*box*/) const {
    return false;  // nanoflann computes it.
  }
};

/// Collects points within a radius: what nanoflann's own searches take differs among its versions.
struct PointsWithin {
  float square_m2;
  std::vector<std::pair<float, std::uint32_t>> found;

  // The names are nanoflann's; its version 1.6 needs the first and the last.
  using DistanceType = float;
  [[nodiscard]] std::size_t size() const { return found.size(); }
  [[nodiscard]] bool full() const { return true; }
  [[nodiscard]] float worstDist() const { return square_m2; }
  bool addPoint(float distance_m2, std::uint32_t index) {
    if (distance_m2 < square_m2) found.emplace_back(distance_m2, index);
    return true;
  }
  void sort() { std::ranges::sort(found); }
};

using Index = nanoflann::KDTreeSingleIndexAdaptor<nanoflann::L2_Simple_Adaptor<float, TreePoints>,
                                                  TreePoints,
                                                  3,
                                                  std::uint32_t>;

}  // namespace

struct NearestSearch::Tree {
  explicit Tree(std::vector<Eigen::Vector3f> given_m)
      : points{std::move(given_m)}, index(3, points) {}

  TreePoints points;
  Index index;
};

NearestSearch::NearestSearch(std::vector<Eigen::Vector3f> points_m) {
  Check(!points_m.empty(), "a cloud to be searched has points");
  tree_ = std::make_unique<const Tree>(std::move(points_m));
}

NearestSearch::~NearestSearch() = default;
NearestSearch::NearestSearch(NearestSearch&&) noexcept = default;
NearestSearch& NearestSearch::operator=(NearestSearch&&) noexcept = default;

const std::vector<Eigen::Vector3f>& NearestSearch::points_m() const {
  return tree_->points.points_m;
}

NearestPoints NearestSearch::Of(const std::vector<Eigen::Vector3f>& queries_m) const {
  constexpr std::size_t kGrain = 1024;
  NearestPoints nearest;
  nearest.distance_m.resize(queries_m.size());
  nearest.index.resize(queries_m.size());
  tbb::parallel_for(tbb::blocked_range<std::size_t>(0, queries_m.size(), kGrain),
                    [&](const tbb::blocked_range<std::size_t>& range) {
                      for (std::size_t i = range.begin(); i != range.end(); ++i) {
                        float square_m2 = 0.0F;
                        tree_->index.knnSearch(queries_m[i].data(), 1, &nearest.index[i],
                                               &square_m2);
                        nearest.distance_m[i] = std::sqrt(square_m2);
                      }
                    });
  return nearest;
}

void NearestSearch::FindNearest(const Eigen::Vector3f& place_m,
                                std::size_t num,
                                std::vector<std::uint32_t>& found) const {
  std::vector<float> squares_m2(num);
  found.resize(num);
  found.resize(tree_->index.knnSearch(place_m.data(), num, found.data(), squares_m2.data()));
}

void NearestSearch::FindWithin(const Eigen::Vector3f& place_m,
                               float radius_m,
                               std::vector<std::uint32_t>& found) const {
  PointsWithin within{.square_m2 = radius_m * radius_m, .found = {}};
  tree_->index.findNeighbors(within, place_m.data(), {});
  within.sort();
  found.clear();
  for (const auto& [square_m2, index] : within.found) found.push_back(index);
}

}  // namespace railcast
