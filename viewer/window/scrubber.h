#pragma once

#include <vtkNew.h>
#include <vtkRenderWindowInteractor.h>
#include <vtkSliderRepresentation2D.h>
#include <vtkSliderWidget.h>

#include <cstddef>
#include <functional>

#include "viewer/draw/look.h"

namespace railcast {

/// The slider at the window's foot that shows which frame it is, and is dragged to another.
class Scrubber {
 public:
  Scrubber(vtkRenderWindowInteractor& interactor, std::function<void(std::size_t)> on_drag);

  /// Out of sight where there are fewer than two frames.
  void Show(std::size_t place, std::size_t num_frames, const Background& background);

 private:
  std::function<void(std::size_t)> on_drag_;
  vtkNew<vtkSliderRepresentation2D> looks_;
  vtkNew<vtkSliderWidget> widget_;
};

}  // namespace railcast
