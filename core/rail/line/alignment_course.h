#pragma once

#include <string>
#include <vector>

#include "core/base/error.h"
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
  double spacing_mm_;          ///< Distance of the rail heads.
};

/// Minimum radius of a line: trams turn at 15 m, and a spline tighter than this is close to a cusp.
inline constexpr double kSmallestRadius_m = 10.0;

/// The curvature (1/m, left positive) that a course specifies, jumps included. Faults are appended
/// to `errors`, with pointers relative to the alignment ("/course/sections/3/s_m: ..."). If there
/// are any, the result is a straight and must not be used.
[[nodiscard]] PiecewiseLinear CurvatureOf(const AlignmentSectionsSpec& course, ErrorList& errors);
[[nodiscard]] PiecewiseLinear CurvatureOf(const AlignmentElementsSpec& course, ErrorList& errors);

/// The step function with `values[i].value` from `values[i].s_m` to the next entry, or `otherwise`
/// if there are no values. Faults are appended to `errors`, with pointers below `pointer`.
[[nodiscard]] PiecewiseLinear StepsOf(const std::vector<ChainageValue>& values,
                                      double length_m,
                                      double otherwise,
                                      const std::string& pointer,
                                      ErrorList& errors);

/// As StepsOf(), but linear between the entries and constant behind the last one; 0 without values.
[[nodiscard]] PiecewiseLinear LinesThrough(const std::vector<ChainageValue>& values,
                                           double length_m,
                                           const std::string& pointer,
                                           ErrorList& errors);

}  // namespace railcast
