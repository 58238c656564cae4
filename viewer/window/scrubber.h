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

/// The slider at the window's foot that shows which frame it is, and is dragged to another.
class Scrubber {
 public:
  /// @param renderer Of the whole window; it stays there.
  Scrubber(vtkRenderWindowInteractor& interactor,
           vtkRenderer& renderer,
           std::function<void(std::size_t)> on_drag);

  /// From `first` to `last`; out of sight where these are one.
  void Show(std::size_t place, std::size_t first, std::size_t last, const Background& background);

 private:
  vtkRenderer& renderer_;
  std::function<void(std::size_t)> on_drag_;
  vtkNew<vtkSliderRepresentation2D> looks_;
  vtkNew<vtkSliderWidget> widget_;
};

}  // namespace railcast
