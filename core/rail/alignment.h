#pragma once

#include <string>
#include <vector>

#include "core/base/transform.h"
#include "core/rail/alignment_spec.h"

namespace railcast {

/// The axis of the line at one chainage.
struct AxisPoint {
  Vector3 position_m;       ///< World, on the axis at top of rail.
  double heading_rad{};     ///< Counterclockwise from east.
  double gradient{};        ///< Rise per metre of chainage.
  double curvature_per_m{}; ///< Left positive.
  double cant_rad{};        ///< Roll about the axis; positive lowers the right rail's side down,
                            ///< i.e. left side up. Leans into the curve.
};

/// A jump in the given figures that was smoothed.
struct SmoothedJump {
  std::string quantity;  ///< "curvature" (1/m) or "gradient" (permil).
  double s_m{};
  double before{};
  double after{};
  double length_m{};     ///< Over which it now changes linearly.
};

/// The line's axis: curvature, gradient and cant as functions of chainage, integrated to positions
/// in double precision. Immutable; thread-safe.
class Alignment {
 public:
  /// @throws InputError if an element or point makes no line or a spline has a cusp. Lines read
  ///   "/pointer: rule (got value)", the pointer relative to the alignment's JSON object.
  explicit Alignment(const AlignmentSpec& spec);

  [[nodiscard]] double length_m() const;
  /// Beyond either end the line goes on straight and level with the end's heading.
  [[nodiscard]] AxisPoint At(double s_m) const;
  [[nodiscard]] double SpeedLimitMps(double s_m) const;
  [[nodiscard]] double tightest_radius_m() const;
  [[nodiscard]] const std::vector<SmoothedJump>& smoothed_jumps() const;

  /// The track frame at chainage `s_m`: x along the axis, y left, z up, with gradient and cant; its
  /// origin `d_m` left of the axis and `h_m` above top of rail.
  [[nodiscard]] Transform WorldFromTrack(double s_m, double d_m = 0.0, double h_m = 0.0) const;
};

}  // namespace railcast
