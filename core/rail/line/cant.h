#pragma once

#include "core/rail/line/piecewise_linear.h"
#include "railcast/alignment.h"

namespace railcast {

/// The distance between the middles of the two rail heads, across which cant in millimetres is
/// measured, is that much more than the gauge: 1500 mm on standard gauge.
inline constexpr double kRailHeadWidth_mm = 65.0;
inline constexpr double kStandardSpacing_mm = 1500.0;

/// The cant that balances the centrifugal force, in mm, is this times the square of the speed in
/// km/h times the curvature in 1/m (docs/physics.md 7.5), on standard gauge.
inline constexpr double kBalancingCant = 11.8;

/// The height of the right above the left rail as a function of chainage, so that it is positive in
/// left curves: surveyed, or by the rule clamp(11.8 v^2 / |R| - deficiency, 0, max) with v in km/h
/// and R in m (docs/physics.md 7.5), averaged over the ramp length so that it is continuous.
class Cant {
 public:
  /// @param curvature Without jumps.
  /// @param speed_kmph Constant on each piece.
  Cant(const PiecewiseLinear& curvature,
       const PiecewiseLinear& speed_kmph,
       const AlignmentSpec& spec);
  /// @param surveyed_mm Without jumps.
  Cant(PiecewiseLinear surveyed_mm, const AlignmentSpec& spec);

  [[nodiscard]] double HeightMm(double s_m) const;
  /// The corresponding roll about the axis: negative (left side down) in left curves.
  [[nodiscard]] double RollRad(double s_m) const;

 private:
  PiecewiseLinear height_mm_;  ///< Before averaging.
  double ramp_m_;              ///< Over which it is averaged; 0 if it is not.
  double spacing_mm_;          ///< Of the rail heads.
};

}  // namespace railcast
