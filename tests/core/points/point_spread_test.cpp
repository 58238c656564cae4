#include "core/points/point_spread.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>
#include <vector>

namespace railcast {
namespace {

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
