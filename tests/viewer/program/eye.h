#pragma once

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <optional>
#include <vector>

#include "railcast/io/recording.h"
#include "railcast/transform.h"
#include "tests/viewer/program/picture.h"

namespace railcast {

/// A textbook pinhole camera that predicts what the program should draw where, without using its
/// code.
class Eye {
 public:
  static constexpr double kViewAngle_deg = 36.0;  ///< Vertical field of view.

  Eye(const Vector3& eye_m, const Vector3& target_m, int width, int height)
      : Eye(eye_m, target_m, Vector3::UnitZ(), width, height) {}
  Eye(const Vector3& eye_m, const Vector3& target_m, const Vector3& up, int width, int height)
      : eye_m_(eye_m), width_(width), height_(height) {
    forward_ = (target_m - eye_m).normalized();
    right_ = forward_.cross(up).normalized();
    up_ = right_.cross(forward_);
  }

  [[nodiscard]] double focal_px() const {
    return 0.5 * height_ / std::tan(0.5 * kViewAngle_deg * std::numbers::pi / 180.0);
  }
  /// Returns the position in pixels from the picture's upper left corner; empty if it is behind the
  /// eye. The pixel (x, y) covers [x, x + 1) and [y, y + 1).
  [[nodiscard]] std::optional<Eigen::Vector2d> See(const Vector3& place_m) const {
    const Vector3 way_m = place_m - eye_m_;
    const double depth_m = way_m.dot(forward_);
    if (depth_m <= 0.01) return std::nullopt;
    return Eigen::Vector2d(0.5 * width_ + focal_px() * way_m.dot(right_) / depth_m,
                           0.5 * height_ - focal_px() * way_m.dot(up_) / depth_m);
  }

 private:
  Vector3 eye_m_;
  Vector3 forward_, right_, up_;
  double width_, height_;
};

/// The driver, chase, side and top cameras of viewer/draw/cameras.h, in metres in the sensor's
/// axes.
inline Eye DriverEye(int width, int height) {
  return {{-1.0, 0.0, 0.3}, {60.0, 0.0, -1.5}, width, height};
}
inline Eye ChaseEye(int width, int height) {
  return {{-20.0, 0.0, 12.0}, {35.0, 0.0, -2.0}, width, height};
}
inline Eye TopEye(int width, int height) {
  return {{55.0, 0.0, 150.0}, {55.0, 0.0, 0.0}, Vector3::UnitX(), width, height};
}

using Corners = std::vector<Eigen::Vector2d>;

/// The eight corners of an object's box in the sensor's axes: bit 0 front, bit 1 left, bit 2 top.
inline std::array<Vector3, 8> BoxCorners_m(const RecordedObject& object) {
  std::array<Vector3, 8> corners;
  for (unsigned i = 0; i < 8; ++i) {
    const Vector3 signs((i & 1U) != 0 ? 0.5 : -0.5, (i & 2U) != 0 ? 0.5 : -0.5,
                        (i & 4U) != 0 ? 0.5 : -0.5);
    corners[i] = object.sensor_from_box * signs.cwiseProduct(object.size_m);
  }
  return corners;
}

/// Returns the outline of a box in a picture, as the corners of its convex hull in order; empty if
/// a corner is behind the eye. (A. M. Andrew, "Another efficient algorithm for convex hulls",
/// 1979.)
inline Corners OutlineOf(const RecordedObject& object, const Eye& eye) {
  Corners seen;
  for (const Vector3& corner : BoxCorners_m(object)) {
    const auto place = eye.See(corner);
    if (!place) return {};
    seen.push_back(*place);
  }
  std::ranges::sort(seen, [](const auto& a, const auto& b) {
    return a.x() < b.x() || (a.x() == b.x() && a.y() < b.y());
  });
  Corners hull;
  const auto add = [&](const Eigen::Vector2d& corner, std::size_t first) {
    while (hull.size() >= first + 2) {
      const Eigen::Vector2d a = hull.back() - hull[hull.size() - 2];
      const Eigen::Vector2d b = corner - hull.back();
      if (a.x() * b.y() - a.y() * b.x() > 0.0) break;
      hull.pop_back();
    }
    hull.push_back(corner);
  };
  for (const auto& corner : seen) add(corner, 0);
  const std::size_t upper = hull.size() - 1;
  for (auto corner = seen.rbegin(); corner != seen.rend(); ++corner) add(*corner, upper);
  hull.pop_back();
  return hull;
}

/// Returns the distance of a place from a line segment.
inline double DistanceToSegment_px(const Eigen::Vector2d& place,
                                   const Eigen::Vector2d& from,
                                   const Eigen::Vector2d& to) {
  const Eigen::Vector2d way = to - from;
  const double length = way.squaredNorm();
  const double share = length == 0.0 ? 0.0 : std::clamp((place - from).dot(way) / length, 0.0, 1.0);
  return (place - from - share * way).norm();
}

/// Returns how far outside an outline a place is; 0 if it is inside.
inline double DistanceOutside_px(const Eigen::Vector2d& place, const Corners& outline) {
  double nearest = std::numeric_limits<double>::infinity();
  bool is_inside = !outline.empty();
  for (std::size_t i = 0; i < outline.size(); ++i) {
    const Eigen::Vector2d& from = outline[i];
    const Eigen::Vector2d& to = outline[(i + 1) % outline.size()];
    const Eigen::Vector2d way = to - from;
    const Eigen::Vector2d offset = place - from;
    if (way.x() * offset.y() - way.y() * offset.x() < 0.0) is_inside = false;
    nearest = std::min(nearest, DistanceToSegment_px(place, from, to));
  }
  return is_inside ? 0.0 : nearest;
}

inline Eigen::Vector2d MiddleOf(const Pixel& pixel) {
  return {pixel.x + 0.5, pixel.y + 0.5};
}

}  // namespace railcast
