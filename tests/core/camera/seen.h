#pragma once

#include <cmath>

#include "railcast/camera.h"

namespace railcast {

/// The pixel coordinates at which a camera sees a point in optical axes, by the formulas of
/// OpenCV's documentation (projectPoints), written out again.
[[nodiscard]] inline Eigen::Vector2d SeenAt(const CameraSpec& spec, const Vector3& point) {
  const DistortionSpec d = spec.distortion.value_or(DistortionSpec{});
  const double x = point.x() / point.z();
  const double y = point.y() / point.z();
  const double r2 = x * x + y * y;
  const double radial = 1.0 + d.k1 * r2 + d.k2 * std::pow(r2, 2) + d.k3 * std::pow(r2, 3);
  const double seen_x = x * radial + 2.0 * d.p1 * x * y + d.p2 * (r2 + 2.0 * x * x);
  const double seen_y = y * radial + d.p1 * (r2 + 2.0 * y * y) + 2.0 * d.p2 * x * y;
  // The edges of the image are half a pixel beyond the centres of the outer pixels.
  const double focal_px =
      0.5 * spec.width_px / std::tan(spec.horizontal_fov_deg * std::acos(-1.0) / 360.0);
  return {focal_px * seen_x + 0.5 * spec.width_px - 0.5,
          focal_px * seen_y + 0.5 * spec.height_px - 0.5};
}

/// A mount at the vehicle's origin that looks along the vehicle's x.
[[nodiscard]] inline Transform ForwardOptical() {
  Transform vehicle_from_camera = Transform::Identity();
  vehicle_from_camera.linear().col(0) = -Vector3::UnitY();
  vehicle_from_camera.linear().col(1) = -Vector3::UnitZ();
  vehicle_from_camera.linear().col(2) = Vector3::UnitX();
  return vehicle_from_camera;
}

}  // namespace railcast
