#pragma once

#include <vtkProp.h>
#include <vtkSmartPointer.h>

#include <array>
#include <optional>
#include <vector>

#include "viewer/composition/coloring.h"
#include "viewer/draw/look.h"

namespace railcast {

/// The legend of a view: a list of categories in the upper left corner, or a scale at the right
/// edge.
struct Legend {
  std::vector<vtkSmartPointer<vtkProp>> props;
  /// The line of one category, for clicks: from the left edge to right_px, in pixels from the
  /// view's lower left corner.
  struct Line {
    double value{};
    double bottom_px{};
    double top_px{};
    double right_px{};
  };
  std::vector<Line> lines;

  /// Returns the line at a place.
  /// @param place_px In the view, from its lower left corner.
  [[nodiscard]] std::optional<Line> LineAt(const std::array<double, 2>& place_px) const;
};

/// Makes a legend. It lists at most 24 categories, those with the most points; a last line counts
/// the others.
/// @param size_px Size of the view.
/// @param beam_kinds Categories of empty beams, listed below those of the points.
[[nodiscard]] Legend MakeLegend(const Coloring& coloring,
                                const std::vector<Category>& beam_kinds,
                                const std::array<int, 2>& size_px,
                                const Background& background);

}  // namespace railcast
