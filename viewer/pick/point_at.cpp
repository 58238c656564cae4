#include "viewer/pick/point_at.h"

#include <cmath>
#include <limits>

namespace railcast {
namespace {

// About the accuracy with which a user clicks.
constexpr double kOnPoint_px = 5.0;
constexpr double kBesidePoint_px = 12.0;

/// The point with the least value so far.
struct Found {
  std::optional<std::size_t> point;
  double least = std::numeric_limits<double>::infinity();

  void Offer(std::size_t i, double value) {
    if (value >= least) return;
    point = i;
    least = value;
  }
};

}  // namespace

std::optional<std::size_t> PointAt(std::span<const float> positions_m,
                                   const Eigen::Matrix4d& clip_from_points,
                                   const std::array<int, 2>& size_px,
                                   double x_px,
                                   double y_px) {
  // The offset from the click in pixels, times w.
  const Eigen::Vector2d half_px(0.5 * size_px[0], 0.5 * size_px[1]);
  const Eigen::Vector2d click_px(x_px, y_px);
  Eigen::Matrix<double, 2, 4> offset_from_points;
  for (int axis = 0; axis < 2; ++axis) {
    offset_from_points.row(axis) = half_px[axis] * clip_from_points.row(axis) +
                                   (half_px[axis] - click_px[axis]) * clip_from_points.row(3);
  }
  const Eigen::RowVector4d w_from_points = clip_from_points.row(3);

  Found nearest_to_eye;
  Found nearest_on_screen;
  for (std::size_t i = 0; 3 * i + 2 < positions_m.size(); ++i) {
    const float* const at_m = positions_m.data() + 3 * i;
    const Eigen::Vector4d point(static_cast<double>(at_m[0]), static_cast<double>(at_m[1]),
                                static_cast<double>(at_m[2]), 1.0);
    const double w = w_from_points.dot(point);
    const double reach = kBesidePoint_px * w;
    const Eigen::Vector2d offset = offset_from_points * point;
    // Most points are rejected here, before any division, and so are points behind the eye and
    // points of NaN.
    if (!(w > 0.0 && std::abs(offset.x()) <= reach && std::abs(offset.y()) <= reach)) continue;
    const Eigen::Vector3d seen = (clip_from_points * point).head<3>() / w;
    if (!(seen.cwiseAbs().maxCoeff() <= 1.0)) continue;
    const double distance_px = offset.norm() / w;
    if (distance_px <= kOnPoint_px) nearest_to_eye.Offer(i, seen.z());
    if (distance_px <= kBesidePoint_px) nearest_on_screen.Offer(i, distance_px);
  }
  return nearest_to_eye.point ? nearest_to_eye.point : nearest_on_screen.point;
}

}  // namespace railcast
