#pragma once

#include <vtkProp.h>
#include <vtkSmartPointer.h>

#include <array>
#include <optional>
#include <vector>

#include "viewer/color/coloring.h"
#include "viewer/draw/look.h"

namespace railcast {

/// What colours mean: a list of kinds in the top left corner, or a scale at the right edge.
struct Legend {
  std::vector<vtkSmartPointer<vtkProp>> props;
  /// A kind's line, for clicks: from the left edge to right_px, in pixels from the view's lower
  /// left corner.
  struct Line {
    double value{};
    double bottom_px{};
    double top_px{};
    double right_px{};
  };
  std::vector<Line> lines;

  /// @param place_px In the view, from its lower left corner.
  [[nodiscard]] std::optional<Line> LineAt(const std::array<double, 2>& place_px) const;
};

/// Lists at most 24 kinds, those with most points; a last line counts the others.
/// @param size_px Of the view.
/// @param beam_kinds Listed below the points' kinds.
[[nodiscard]] Legend MakeLegend(const Coloring& coloring,
                                const std::vector<Category>& beam_kinds,
                                const std::array<int, 2>& size_px,
                                const Background& background);

}  // namespace railcast
