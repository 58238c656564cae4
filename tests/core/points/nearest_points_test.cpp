#include "core/points/nearest_points.h"

#include <gtest/gtest.h>
#include <pcl/search/brute_force.h>

#include <random>

namespace railcast {
namespace {

using Points = std::vector<Eigen::Vector3f>;

/// Returns points near 400 m2 of a horizontal plane.
Points MadePoints(std::size_t num_points, float z_m, unsigned seed) {
  Points points_m;
  std::mt19937 random(seed);
  std::uniform_real_distribution<float> place_m(0.0F, 20.0F);
  std::normal_distribution<float> height_m(z_m, 0.5F);
  for (std::size_t i = 0; i < num_points; ++i) {
    const float x_m = place_m(random), y_m = place_m(random);
    points_m.emplace_back(x_m, y_m, height_m(random));
  }
  return points_m;
}

/// PCL's search through all points.
class AllPoints {
 public:
  explicit AllPoints(const Points& points_m) {
    const pcl::PointCloud<pcl::PointXYZ>::Ptr cloud(new pcl::PointCloud<pcl::PointXYZ>());
    for (const Eigen::Vector3f& p : points_m) cloud->emplace_back(p.x(), p.y(), p.z());
    search_.setInputCloud(cloud);
  }
  std::vector<std::uint32_t> Nearest(const Eigen::Vector3f& place_m, int num) {
    pcl::Indices found;
    std::vector<float> squares_m2;
    search_.nearestKSearch({place_m.x(), place_m.y(), place_m.z()}, num, found, squares_m2);
    return {found.begin(), found.end()};
  }
  std::vector<std::uint32_t> Within(const Eigen::Vector3f& place_m, double radius_m) {
    pcl::Indices found;
    std::vector<float> squares_m2;
    search_.radiusSearch({place_m.x(), place_m.y(), place_m.z()}, radius_m, found, squares_m2);
    return {found.begin(), found.end()};
  }

 private:
  pcl::search::BruteForce<pcl::PointXYZ> search_{/*sorted_results=*/true};
};

TEST(NearestSearch, FindsWhatPclsBruteForceFinds) {
  // Enough queries for several threads.
  const Points queries_m = MadePoints(3000, 0.0F, 1);
  const Points points_m = MadePoints(500, 0.3F, 2);
  const NearestPoints nearest = NearestSearch(points_m).Of(queries_m);
  ASSERT_EQ(nearest.index.size(), queries_m.size());
  ASSERT_EQ(nearest.distance_m.size(), queries_m.size());
  AllPoints all(points_m);
  for (std::size_t i = 0; i < queries_m.size(); ++i) {
    const std::uint32_t index = all.Nearest(queries_m[i], 1).at(0);
    ASSERT_EQ(nearest.index[i], index);
    ASSERT_FLOAT_EQ(nearest.distance_m[i], (points_m[index] - queries_m[i]).norm());
  }
}

TEST(NearestSearch, OrdersNeighborsByDistance) {
  const Points points_m = MadePoints(500, 0.3F, 2);
  const NearestSearch search(points_m);
  AllPoints all(points_m);
  std::vector<std::uint32_t> found;
  for (const Eigen::Vector3f& place_m : MadePoints(50, 0.0F, 1)) {
    search.FindNearest(place_m, 13, found);
    EXPECT_EQ(found, all.Nearest(place_m, 13));
    search.FindWithin(place_m, 2.5F, found);
    EXPECT_EQ(found, all.Within(place_m, 2.5));
  }
}

TEST(NearestSearch, FindsAllPointsWhereThereAreFewer) {
  const NearestSearch search({{1.0F, 0.0F, 0.0F}, {0.5F, 0.0F, 0.0F}});
  std::vector<std::uint32_t> found;
  search.FindNearest(Eigen::Vector3f::Zero(), 5, found);
  EXPECT_EQ(found, (std::vector<std::uint32_t>{1, 0}));
  search.FindWithin(Eigen::Vector3f::Zero(), 0.1F, found);
  EXPECT_TRUE(found.empty());
}

TEST(NearestSearch, FindsNothingForNoQueries) {
  EXPECT_TRUE(NearestSearch(MadePoints(1, 0.0F, 1)).Of({}).index.empty());
}

}  // namespace
}  // namespace railcast
