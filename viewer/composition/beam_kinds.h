#pragma once

#include <vector>

#include "railcast/io/recording.h"
#include "viewer/composition/coloring.h"

namespace railcast {

/// Lists the categories of empty beams for the legend: the firings without a return, by outcome, or
/// as one category where the recording has no outcomes.
[[nodiscard]] std::vector<Category> BeamKinds(const RecordedFrame& recorded);

}  // namespace railcast
