#pragma once

#include <vtkRenderer.h>

#include <array>

#include "viewer/coloring.h"

namespace railcast {

/// Adds what the colours mean: a list of kinds in the top left corner, or a scale at the right
/// edge.
void AddLegend(vtkRenderer& renderer, const Coloring& coloring, const std::array<int, 2>& size_px);

}  // namespace railcast
