#pragma once

#include "core/rail/line/alignment_spec.h"
#include "core/rail/line/piecewise_linear.h"

namespace railcast {

/// Between the heads of the two rails, across which cant is given in millimetres.
inline constexpr double kRailHeadSpacing_mm = 1500.0;

/// The height of the outer above the inner rail as a function of chainage, by rule:
/// clamp(11.8 v^2 / |R| - deficiency, 0, max) with v in km/h and R in m (physics.md 7.1), averaged
/// over the ramp length, so that it is continuous. Positive in left curves.
class Cant {
 public:
  /// @param curvature Without jumps.
  /// @param speed_kmph Constant on each of its pieces.
  Cant(const PiecewiseLinear& curvature,
       const PiecewiseLinear& speed_kmph,
       const AlignmentSpec& spec);

  [[nodiscard]] double HeightMm(double s_m) const;
  /// The roll about the axis that this is: negative (left side down) in left curves.
  [[nodiscard]] double RollRad(double s_m) const;

 private:
  PiecewiseLinear by_rule_mm_;  ///< Before averaging.
  double ramp_m_;
};

}  // namespace railcast
