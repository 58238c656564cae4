#pragma once

#include <string>
#include <vector>

#include "core/base/error.h"
#include "core/rail/line/piecewise_linear.h"
#include "railcast/alignment.h"

namespace railcast {

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

/// As above, but linear between the entries and constant behind the last one; 0 without values.
[[nodiscard]] PiecewiseLinear LinesThrough(const std::vector<ChainageValue>& values,
                                           double length_m,
                                           const std::string& pointer,
                                           ErrorList& errors);

}  // namespace railcast
