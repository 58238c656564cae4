#include "core/camera/lens.h"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>

#include "core/base/units.h"

namespace railcast {

Intrinsics IntrinsicsOf(const CameraSpec& spec) {
  const double width_px = spec.width_px;
  return {.focal_px = 0.5 * width_px / std::tan(0.5 * RadFromDeg(spec.horizontal_fov_deg)),
          .cx_px = 0.5 * (width_px - 1.0),
          .cy_px = 0.5 * (static_cast<double>(spec.height_px) - 1.0)};
}

Eigen::Vector2d Lens::Distort(const Eigen::Vector2d& direction) const {
  const DistortionSpec& d = distortion_;
  const double x = direction.x();
  const double y = direction.y();
  const double r2 = direction.squaredNorm();
  const double radial = 1.0 + r2 * (d.k1 + r2 * (d.k2 + r2 * d.k3));
  return {x * radial + 2.0 * d.p1 * x * y + d.p2 * (r2 + 2.0 * x * x),
          y * radial + d.p1 * (r2 + 2.0 * y * y) + 2.0 * d.p2 * x * y};
}

Eigen::Matrix2d Lens::Slope(const Eigen::Vector2d& direction) const {
  const DistortionSpec& d = distortion_;
  const double x = direction.x();
  const double y = direction.y();
  const double r2 = direction.squaredNorm();
  const double radial = 1.0 + r2 * (d.k1 + r2 * (d.k2 + r2 * d.k3));
  const double by_r2 = d.k1 + r2 * (2.0 * d.k2 + r2 * 3.0 * d.k3);
  const double mixed = 2.0 * x * y * by_r2 + 2.0 * d.p1 * x + 2.0 * d.p2 * y;
  Eigen::Matrix2d slope;
  slope << radial + 2.0 * x * x * by_r2 + 2.0 * d.p1 * y + 6.0 * d.p2 * x, mixed, mixed,
      radial + 2.0 * y * y * by_r2 + 6.0 * d.p1 * y + 2.0 * d.p2 * x;
  return slope;
}

Eigen::Vector2d Lens::Project(const Vector3& point) const {
  const Eigen::Vector2d seen = Distort(point.head<2>() / point.z());
  return intrinsics_.focal_px * seen + Eigen::Vector2d(intrinsics_.cx_px, intrinsics_.cy_px);
}

std::optional<Eigen::Vector2d> Lens::DirectionAt(double u_px, double v_px) const {
  const Eigen::Vector2d seen((u_px - intrinsics_.cx_px) / intrinsics_.focal_px,
                             (v_px - intrinsics_.cy_px) / intrinsics_.focal_px);
  if (!is_distorted_) return seen;
  constexpr int kMostSteps = 50;
  constexpr double kTolerance = 1e-12;
  Eigen::Vector2d direction = seen;
  for (int step = 0; step < kMostSteps; ++step) {
    const Eigen::Vector2d error = Distort(direction) - seen;
    if (error.lpNorm<Eigen::Infinity>() <= kTolerance) return direction;
    const Eigen::Matrix2d slope = Slope(direction);
    if (!(slope.determinant() > 0.0)) return std::nullopt;
    direction -= slope.inverse() * error;
  }
  return std::nullopt;
}

bool Lens::GrowsUpTo(double end) const {
  constexpr int kNumSteps = 64;
  const DistortionSpec& d = distortion_;
  for (int i = 1; i <= kNumSteps; ++i) {
    const double r = end * i / kNumSteps;
    const double r2 = r * r;
    if (!(1.0 + r2 * (3.0 * d.k1 + r2 * (5.0 * d.k2 + r2 * 7.0 * d.k3)) > 0.0)) return false;
  }
  return true;
}

bool IsCameraName(std::string_view name) {
  constexpr std::size_t kMostLetters = 64;
  return !name.empty() && name.size() <= kMostLetters && std::ranges::all_of(name, [](char letter) {
    return (letter >= 'a' && letter <= 'z') || (letter >= '0' && letter <= '9') || letter == '_';
  });
}

bool IsInvertible(const CameraSpec& spec) {
  const Lens lens(spec);
  constexpr int kNumSteps = 64;
  double radius = 0.0;
  for (int row = 0; row <= kNumSteps; ++row) {
    for (int column = 0; column <= kNumSteps; ++column) {
      // From edge to edge: pixels reach half a pixel beyond their centres.
      const auto direction =
          lens.DirectionAt(static_cast<double>(spec.width_px) * column / kNumSteps - 0.5,
                           static_cast<double>(spec.height_px) * row / kNumSteps - 0.5);
      if (!direction) return false;
      radius = std::max(radius, direction->norm());
    }
  }
  return lens.GrowsUpTo(radius);
}

}  // namespace railcast
