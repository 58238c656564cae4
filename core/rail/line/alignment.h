#pragma once

#include <memory>
#include <string>
#include <vector>

#include "core/base/transform.h"
#include "core/rail/line/alignment_spec.h"

namespace railcast {

/// The axis of the line at one chainage.
struct AxisPoint {
  Vector3 position_m;        ///< World, on the axis at top of rail.
  double heading_rad{};      ///< Counterclockwise from east; grows on through full turns.
  double gradient{};         ///< Rise per metre of chainage.
  double curvature_per_m{};  ///< Left positive.
  double cant_rad{};  ///< Roll about the axis as in RotationFromYawPitchRoll: positive raises
                      ///< the left side. Leans into the curve, so negative in left curves.
};

/// A jump in the given figures that was smoothed.
struct SmoothedJump {
  std::string quantity;  ///< "curvature" (1/m) or "gradient" (permil).
  double s_m{};
  double before{};
  double after{};
  double length_m{};  ///< Over which it now changes linearly; `s_m` is its middle.
};

/// The line's axis: curvature, gradient and cant as functions of chainage, integrated to positions
/// in double precision. Immutable, thread-safe, cheap to copy.
///
/// Chainage is arc length in plan. Sections and elements are integrated from their curvature
/// (PlanCourse), a spline is evaluated (PlanSpline); heights are the exact integral of the
/// gradient.
class Alignment {
 public:
  /// @throws InputError if an element or point makes no line or a spline has a cusp. Lines read
  ///   "/pointer: rule (got value)", the pointer relative to the alignment's JSON object.
  explicit Alignment(const AlignmentSpec& spec);

  [[nodiscard]] double length_m() const;
  /// Beyond either end the line goes on straight and level with the end's heading and cant.
  [[nodiscard]] AxisPoint At(double s_m) const;
  /// Infinite where the spec has no limits.
  [[nodiscard]] double SpeedLimitMps(double s_m) const;
  /// After smoothing; infinite where the line is straight.
  [[nodiscard]] double tightest_radius_m() const;
  /// First those of the curvature, then those of the gradient, each in order of chainage.
  [[nodiscard]] const std::vector<SmoothedJump>& smoothed_jumps() const;

  /// The track frame at chainage `s_m`: x along the axis, y left, z up, with gradient and cant; its
  /// origin `d_m` left of the axis and level with it, and `h_m` above top of rail. So tracks side
  /// by side lie at one height and each leans about its own axis, as in a real double track.
  [[nodiscard]] Transform WorldFromTrack(double s_m, double d_m = 0.0, double h_m = 0.0) const;

 private:
  struct Parts;
  std::shared_ptr<const Parts> parts_;
};

}  // namespace railcast
