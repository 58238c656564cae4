#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <memory>
#include <optional>
#include <vector>

#include "railcast/transform.h"

namespace railcast {

/// A cloud that can be laid on another one: its points, thinned to one for each cube of 0.4 m so
/// that near ones do not outweigh all others, with the normals of the surfaces that they are on.
class ThinnedCloud {
 public:
  static constexpr double kCell_m = 0.4;

  /// @param points_m Finite.
  explicit ThinnedCloud(const std::vector<Eigen::Vector3f>& points_m);
  [[nodiscard]] std::size_t size() const;

  struct Points;
  [[nodiscard]] const std::shared_ptr<const Points>& points() const { return points_; }

 private:
  std::shared_ptr<const Points> points_;
};

/// Where a cloud lies on another one.
struct LaidCloud {
  Transform onto_from_cloud;
  double residual_m{};  ///< Root mean square of the distances of nearest points up to 2 m.
};

/// Clouds with fewer points after thinning cannot be laid.
inline constexpr std::size_t kFewestLaid = 100;

/// Lays a cloud on another one: iterative closest points, from points to planes (Chen and Medioni,
/// 1992), with PCL. Points more than 2 m from all others have no part in it.
/// @param guess Where the cloud is about, in the axes of the other.
/// @returns Nothing where it does not converge.
/// @pre Both have kFewestLaid points.
[[nodiscard]] std::optional<LaidCloud> LayOn(const ThinnedCloud& onto,
                                             const ThinnedCloud& cloud,
                                             const Transform& guess);

/// Makes PCL say nothing on stderr: it complains of single neighbourhoods that it cannot use, in a
/// format of its own, which figures account for already. For sources whose calls may complain.
void DropPclMessages();

}  // namespace railcast
