#pragma once

#include <vector>

#include "core/io/recording/recording.h"
#include "viewer/color/coloring.h"

namespace railcast {

/// For the legend of empty beams: the firings that brought nothing back, by outcome, or as one kind
/// where the recording does not say why.
[[nodiscard]] std::vector<Category> BeamKinds(const RecordedFrame& recorded);

}  // namespace railcast
