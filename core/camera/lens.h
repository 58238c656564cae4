#pragma once

#include <Eigen/Core>
#include <optional>

#include "railcast/camera.h"

namespace railcast {

/// The direction of each place of an image, and the place of each direction.
class Lens {
 public:
  explicit Lens(const CameraSpec& spec)
      : intrinsics_(IntrinsicsOf(spec)),
        distortion_(spec.distortion.value_or(DistortionSpec{})),
        is_distorted_(distortion_ != DistortionSpec{}) {}

  /// Returns the pixel coordinates of a point in optical axes.
  /// @pre point.z() > 0.
  [[nodiscard]] Eigen::Vector2d Project(const Vector3& point) const;

  [[nodiscard]] bool is_distorted() const { return is_distorted_; }

  /// Returns (x, y) of the direction (x, y, 1) that is seen at (u, v). Distortion is inverted by
  /// Newton's method, to 1e-12. Steps are halved until they come closer.
  /// @return Nothing if the search does not converge.
  [[nodiscard]] std::optional<Eigen::Vector2d> DirectionAt(double u_px, double v_px) const;

  /// Whether the distances of places from the optical axis grow with those of their directions, up
  /// to `end`, a tangent.
  [[nodiscard]] bool GrowsUpTo(double end) const;

 private:
  [[nodiscard]] Eigen::Vector2d Distort(const Eigen::Vector2d& direction) const;
  [[nodiscard]] Eigen::Matrix2d Slope(const Eigen::Vector2d& direction) const;

  Intrinsics intrinsics_;
  DistortionSpec distortion_;
  bool is_distorted_;
};

}  // namespace railcast
