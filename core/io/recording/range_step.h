#pragma once

#include <vector>

#include "railcast/io/recording.h"

namespace railcast {

/// The step in which a frame's ranges come, by their differences from point to point; 0 if there is
/// none, or none that shows (FindStep() in core/base/rounded_scale.h).
[[nodiscard]] double RangeStep_m(const RecordedFrame& recorded);

/// As RangeStep_m() for any values in the order of firings.
/// @param most Differences beyond it are not of one surface. NaN is left out.
[[nodiscard]] double StepOfValues(const std::vector<double>& values, double most);

}  // namespace railcast
