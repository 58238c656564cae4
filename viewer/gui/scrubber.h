#pragma once

#include <vtkNew.h>
#include <vtkRenderWindowInteractor.h>
#include <vtkRenderer.h>
#include <vtkSliderRepresentation2D.h>
#include <vtkSliderWidget.h>

#include <cstddef>
#include <functional>

#include "viewer/draw/look.h"

namespace railcast {

/// The slider at the foot of the window, which shows the place of the frame and can be dragged to
/// another.
class Scrubber {
 public:
  /// @param renderer Renderer of the whole window, in which the slider stays.
  Scrubber(vtkRenderWindowInteractor& interactor,
           vtkRenderer& renderer,
           std::function<void(std::size_t)> on_drag);

  /// Shows a place between `first` and `last`; hides the slider where these are equal.
  void Show(std::size_t place, std::size_t first, std::size_t last, const Background& background);

 private:
  vtkRenderer& renderer_;
  std::function<void(std::size_t)> on_drag_;
  vtkNew<vtkSliderRepresentation2D> looks_;
  vtkNew<vtkSliderWidget> widget_;
};

}  // namespace railcast
