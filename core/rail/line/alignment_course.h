#pragma once

#include <string>
#include <vector>

#include "core/base/error.h"
#include "core/rail/line/alignment_spec.h"
#include "core/rail/line/piecewise_linear.h"

namespace railcast {

/// No line is tighter than this: trams turn at 15 m, and a tighter spline is about to have a cusp.
inline constexpr double kSmallestRadius_m = 10.0;

/// The curvature (1/m, left positive) that a course's figures state, jumps included. Faults go to
/// `errors` with pointers relative to the alignment ("/course/sections/3/s_m: ...").
/// @pre For the result to be used, `errors` stayed as it was; else it is a straight.
[[nodiscard]] PiecewiseLinear CurvatureOf(const AlignmentSectionsSpec& course, ErrorList& errors);
[[nodiscard]] PiecewiseLinear CurvatureOf(const AlignmentElementsSpec& course, ErrorList& errors);

/// The function that is `values[i].value` from `values[i].s_m` to the next; `otherwise`
/// where there are no values. Faults go to `errors` with pointers below `pointer`.
[[nodiscard]] PiecewiseLinear StepsOf(const std::vector<ChainageValue>& values,
                                      double length_m,
                                      double otherwise,
                                      const std::string& pointer,
                                      ErrorList& errors);

}  // namespace railcast
