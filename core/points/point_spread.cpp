#include "core/points/point_spread.h"

#include <pcl/common/centroid.h>
#include <pcl/point_types.h>

#include <Eigen/Eigenvalues>

#include "core/base/error.h"

namespace railcast {

PointSpread SpreadOf(const std::vector<Eigen::Vector3f>& points_m) {
  Check(!points_m.empty(), "points that spread are some");
  pcl::PointCloud<pcl::PointXYZ> cloud;
  cloud.reserve(points_m.size());
  for (const Eigen::Vector3f& point_m : points_m) {
    cloud.push_back({point_m.x(), point_m.y(), point_m.z()});
  }
  PointSpread spread;
  Eigen::Vector4d mean_m = Eigen::Vector4d::Zero();
  pcl::computeMeanAndCovarianceMatrix(cloud, spread.covariance_m2, mean_m);
  spread.mean_m = mean_m.head<3>();
  // PCL's own pcl::eigen33() takes 350 ns instead of 150. It loses the least of three deviations
  // where two are small: all of 0.1 mm beside 1 m, of which this keeps eight digits.
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver(spread.covariance_m2);
  spread.axes = solver.eigenvectors();
  spread.variances_m2 = solver.eigenvalues().cwiseMax(0.0);
  return spread;
}

}  // namespace railcast
