#pragma once

#include <vector>

#include "viewer/coloring.h"

namespace railcast {

/// The colour of each point; grey for those without a value.
[[nodiscard]] std::vector<Rgb> PointColors(const Coloring& coloring);

}  // namespace railcast
