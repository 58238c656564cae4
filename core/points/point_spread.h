#pragma once

#include <Eigen/Core>
#include <vector>

#include "railcast/transform.h"

namespace railcast {

/// How points lie about their mean: their principal components, of which the first is the normal of
/// the plane that fits them best, and the last the direction of the line.
struct PointSpread {
  Vector3 mean_m = Vector3::Zero();
  Eigen::Matrix3d covariance_m2 = Eigen::Matrix3d::Zero();  ///< Divided by the number of points.
  /// Columns: unit vectors of either sign, from the least to the greatest variance.
  Eigen::Matrix3d axes = Eigen::Matrix3d::Identity();
  Vector3 variances_m2 = Vector3::Zero();  ///< Along the axes; not negative.
};

/// @pre There are points, and all are finite.
[[nodiscard]] PointSpread SpreadOf(const std::vector<Eigen::Vector3f>& points_m);

}  // namespace railcast
