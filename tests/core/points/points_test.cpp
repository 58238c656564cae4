#include <dlfcn.h>
#include <gtest/gtest.h>
#include <pcl/search/brute_force.h>
#include <Eigen/Geometry>

#include <cmath>
#include <random>
#include <string>
#include <vector>

#include "core/points/nearest_points.h"
#include "core/points/point_spread.h"

namespace railcast {
namespace {

using Points = std::vector<Eigen::Vector3f>;

/// Returns points near 400 m2 of a horizontal plane.
Points ScatteredPoints(std::size_t num_points, float z_m, unsigned seed) {
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

/// The file that has the code at an address.
std::string FileAt(const void* address) {
  Dl_info found{};
  return dladdr(address, &found) != 0 ? found.dli_fname : "";
}

// In libpcl_kdtree each search makes a system call (nearest_points.cpp says why).
TEST(NearestSearch, IsNotThatOfDebiansLibrary) {
  const void* search = dlsym(RTLD_DEFAULT,
                             "_ZNK5flann7NNIndexINS_9L2_SimpleIfEEE9knnSearchERKNS_6MatrixIfEERNS4_"
                             "ImEERS5_mRKNS_12SearchParamsE");
  const std::string own = FileAt(reinterpret_cast<const void*>(&FileAt));
  ASSERT_NE(own, "");
  EXPECT_EQ(FileAt(search), own);
}

TEST(NearestSearch, FindsWhatPclsBruteForceFinds) {
  // Enough queries for several threads.
  const Points queries_m = ScatteredPoints(3000, 0.0F, 1);
  const Points points_m = ScatteredPoints(500, 0.3F, 2);
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
  const Points points_m = ScatteredPoints(500, 0.3F, 2);
  const NearestSearch search(points_m);
  AllPoints all(points_m);
  std::vector<std::uint32_t> found;
  for (const Eigen::Vector3f& place_m : ScatteredPoints(50, 0.0F, 1)) {
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
  EXPECT_TRUE(NearestSearch(ScatteredPoints(1, 0.0F, 1)).Of({}).index.empty());
}

/// Six points whose standard deviations along the turned axes are the given ones.
std::vector<Eigen::Vector3f> PointsWith(const Vector3& deviations_m,
                                        const Eigen::Matrix3d& turn,
                                        const Vector3& mean_m) {
  std::vector<Eigen::Vector3f> points_m;
  for (Eigen::Index axis = 0; axis < 3; ++axis) {
    const Vector3 offset_m = std::sqrt(3.0) * deviations_m[axis] * turn.col(axis);
    points_m.emplace_back((mean_m + offset_m).cast<float>());
    points_m.emplace_back((mean_m - offset_m).cast<float>());
  }
  return points_m;
}

Eigen::Matrix3d Turn() {
  return Eigen::AngleAxisd(0.7, Vector3(1.0, 2.0, 3.0).normalized()).toRotationMatrix();
}

/// What rounding to float32 may change of a place whose coordinates are less than `most_m`.
double Rounding_m(double most_m) {
  return std::sqrt(3.0) * most_m * std::pow(2.0, -24);
}

TEST(PointSpread, IsThatOfThePointsFarFromTheSensor) {
  const Vector3 mean_m(120.0, -60.0, 3.0);
  const Vector3 deviations_m(0.005, 0.3, 0.5);
  const PointSpread spread = SpreadOf(PointsWith(deviations_m, Turn(), mean_m));
  const double tolerance_m = Rounding_m(128.0);
  EXPECT_LT((spread.mean_m - mean_m).norm(), tolerance_m);
  EXPECT_LT((spread.variances_m2.cwiseSqrt() - deviations_m).cwiseAbs().maxCoeff(), tolerance_m);
  const Vector3 normal = Turn().col(0);
  EXPECT_LT(spread.axes.col(0).cross(normal).norm(), tolerance_m / deviations_m[1]);
  const Eigen::Matrix3d covariance_m2 =
      Turn() * deviations_m.cwiseAbs2().asDiagonal() * Turn().transpose();
  EXPECT_LT((spread.covariance_m2 - covariance_m2).norm(), 4.0 * deviations_m[2] * tolerance_m);
}

TEST(PointSpread, KeepsTheThicknessOfAWire) {
  const Vector3 deviations_m(1e-4, 2e-4, 1.0);
  const PointSpread spread = SpreadOf(PointsWith(deviations_m, Turn(), Vector3::Zero()));
  EXPECT_LT((spread.variances_m2.cwiseSqrt() - deviations_m).cwiseAbs().maxCoeff(),
            Rounding_m(2.0));
}

TEST(PointSpread, IsNoneOfOnePoint) {
  const PointSpread spread = SpreadOf({{1.0F, 2.0F, 3.0F}});
  EXPECT_EQ(spread.mean_m, Vector3(1.0, 2.0, 3.0));
  EXPECT_EQ(spread.variances_m2, Vector3::Zero());
}

}  // namespace
}  // namespace railcast
