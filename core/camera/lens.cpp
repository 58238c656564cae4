#include "core/camera/lens.h"

#include <tbb/blocked_range.h>
#include <tbb/parallel_reduce.h>

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>

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
  Eigen::Vector2d seen((u_px - intrinsics_.cx_px) / intrinsics_.focal_px,
                       (v_px - intrinsics_.cy_px) / intrinsics_.focal_px);
  if (!is_distorted_) return seen;
  constexpr int kMostSteps = 50;
  constexpr int kMostHalvings = 30;
  constexpr double kTolerance = 1e-12;
  // Towards the axis, where the determinant is 1.
  Eigen::Vector2d direction = seen;
  for (int i = 0; i < kMostHalvings && !(Slope(direction).determinant() > 0.0); ++i) {
    direction *= 0.5;
  }
  Eigen::Vector2d error = Distort(direction) - seen;
  for (int step = 0; step < kMostSteps; ++step) {
    const double size = error.lpNorm<Eigen::Infinity>();
    if (size <= kTolerance) return direction;
    // A full step may overshoot or leave the region where the image is not folded over.
    const Eigen::Vector2d start = direction;
    Eigen::Vector2d change = Slope(start).inverse() * error;
    bool is_better = false;
    for (int i = 0; i < kMostHalvings && !is_better; ++i) {
      direction = start - change;
      error = Distort(direction) - seen;
      is_better = error.lpNorm<Eigen::Infinity>() < size && Slope(direction).determinant() > 0.0;
      change *= 0.5;
    }
    if (!is_better) return std::nullopt;
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

namespace {

/// Places of an image at equal distances along a row.
struct PlacesOfRow {
  double v_px;
  double first_u_px;
  double step_px;
  std::uint32_t num_places;
};

// The largest tangent from the optical axis to a direction that is seen at one of the places;
// infinite if there is a place without a direction.
double RadiusOf(const PlacesOfRow& row, const Lens& lens) {
  double radius = 0.0;
  for (std::uint32_t i = 0; i < row.num_places; ++i) {
    const auto direction = lens.DirectionAt(row.first_u_px + row.step_px * i, row.v_px);
    if (!direction) return std::numeric_limits<double>::infinity();
    radius = std::max(radius, direction->norm());
  }
  return radius;
}

// As RadiusOf(), of a grid from edge to edge: pixels reach half a pixel beyond their centres.
double RadiusOfGrid(const CameraSpec& spec, const Lens& lens) {
  constexpr std::uint32_t kNumSteps = 64;
  const double across_px = static_cast<double>(spec.width_px) / kNumSteps;
  const double down_px = static_cast<double>(spec.height_px) / kNumSteps;
  double radius = 0.0;
  for (std::uint32_t i = 0; i <= kNumSteps && std::isfinite(radius); ++i) {
    radius = std::max(radius, RadiusOf({down_px * i - 0.5, -0.5, across_px, kNumSteps + 1}, lens));
  }
  return radius;
}

// As RadiusOf(), of all centres of pixels.
double RadiusOfPixels(const CameraSpec& spec, const Lens& lens) {
  using Rows = tbb::blocked_range<std::uint32_t>;
  return tbb::parallel_reduce(
      Rows(0, spec.height_px), 0.0,
      [&](const Rows& rows, double radius) {
        for (std::uint32_t row = rows.begin(); row != rows.end() && std::isfinite(radius); ++row) {
          radius =
              std::max(radius, RadiusOf({static_cast<double>(row), 0.0, 1.0, spec.width_px}, lens));
        }
        return radius;
      },
      [](double a, double b) { return std::max(a, b); });
}

}  // namespace

bool IsInvertible(const CameraSpec& spec) {
  const Lens lens(spec);
  if (!lens.is_distorted()) return true;
  // The grid includes the edges, and finds most faults at little cost. The search can fail between
  // its places too, so each direction that Camera asks for is tried.
  const auto is_unique = [&](double radius) {
    return std::isfinite(radius) && lens.GrowsUpTo(radius);
  };
  return is_unique(RadiusOfGrid(spec, lens)) && is_unique(RadiusOfPixels(spec, lens));
}

}  // namespace railcast
