#pragma once

#include <vtkProp.h>
#include <vtkSmartPointer.h>

#include <array>
#include <vector>

#include "viewer/draw/look.h"
#include "viewer/frames/camera_picture.h"

namespace railcast {

/// A camera's image in the upper right corner of a view, with its title below.
struct Inset {
  std::vector<vtkSmartPointer<vtkProp>> props;
  /// The image's lower left and upper right corner, in pixels from the view's lower left one.
  std::array<double, 2> from_px{};
  std::array<double, 2> to_px{};

  [[nodiscard]] bool Holds(const std::array<double, 2>& place_px) const {
    return place_px[0] >= from_px[0] && place_px[0] < to_px[0] && place_px[1] >= from_px[1] &&
           place_px[1] < to_px[1];
  }
};

/// Makes an inset that takes up to two fifths of the view's width and height.
/// @param size_px Size of the view.
/// @param has_scale Whether room is left for the legend's scale at the right edge.
[[nodiscard]] Inset MakeInset(const CameraPicture& picture,
                              const std::array<int, 2>& size_px,
                              bool has_scale,
                              const Background& background);

}  // namespace railcast
