#include "core/io/cloud/nearest_points.h"

#include <gtest/gtest.h>
#include <pcl/search/brute_force.h>

#include <cmath>
#include <random>

namespace railcast {
namespace {

/// Returns points near 400 m2 of a horizontal plane.
pcl::PointCloud<pcl::PointXYZ>::Ptr MadeCloud(std::size_t num_points, float z_m, unsigned seed) {
  pcl::PointCloud<pcl::PointXYZ>::Ptr cloud(new pcl::PointCloud<pcl::PointXYZ>());
  std::mt19937 random(seed);
  std::uniform_real_distribution<float> place_m(0.0F, 20.0F);
  std::normal_distribution<float> height_m(z_m, 0.5F);
  for (std::size_t i = 0; i < num_points; ++i) {
    cloud->emplace_back(place_m(random), place_m(random), height_m(random));
  }
  return cloud;
}

TEST(NearestSearch, FindsWhatPclsBruteForceFinds) {
  // Enough queries for several threads.
  const auto queries = MadeCloud(3000, 0.0F, 1);
  const auto cloud = MadeCloud(500, 0.3F, 2);
  const NearestPoints nearest = NearestSearch(cloud).Of(*queries);
  ASSERT_EQ(nearest.index.size(), queries->size());
  ASSERT_EQ(nearest.distance_m.size(), queries->size());
  pcl::search::BruteForce<pcl::PointXYZ> all;
  all.setInputCloud(cloud);
  pcl::Indices index(1);
  std::vector<float> square_m2(1);
  for (std::size_t i = 0; i < queries->size(); ++i) {
    all.nearestKSearch((*queries)[i], 1, index, square_m2);
    ASSERT_EQ(nearest.index[i], static_cast<std::uint32_t>(index[0]));
    ASSERT_FLOAT_EQ(nearest.distance_m[i], std::sqrt(square_m2[0]));
  }
}

TEST(NearestSearch, FindsNothingForNoQueries) {
  EXPECT_TRUE(NearestSearch(MadeCloud(1, 0.0F, 1)).Of({}).index.empty());
}

}  // namespace
}  // namespace railcast
