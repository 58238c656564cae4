#include "viewer/gui/scrubber.h"

#include <vtkCallbackCommand.h>
#include <vtkProperty2D.h>
#include <vtkTextProperty.h>

#include <cmath>
#include <utility>

#include "viewer/draw/vtk_values.h"

namespace railcast {

Scrubber::Scrubber(vtkRenderWindowInteractor& interactor,
                   vtkRenderer& renderer,
                   std::function<void(std::size_t)> on_drag)
    : renderer_(renderer), on_drag_(std::move(on_drag)) {
  looks_->GetPoint1Coordinate()->SetCoordinateSystemToNormalizedDisplay();
  looks_->GetPoint1Coordinate()->SetValue(0.02, 0.016);
  looks_->GetPoint2Coordinate()->SetCoordinateSystemToNormalizedDisplay();
  looks_->GetPoint2Coordinate()->SetValue(0.98, 0.016);
  looks_->SetTubeWidth(0.004);
  looks_->SetSliderLength(0.012);
  looks_->SetSliderWidth(0.02);
  looks_->SetEndCapLength(0.0);
  looks_->ShowSliderLabelOff();
  looks_->SetTitleText("");
  widget_->SetInteractor(&interactor);
  widget_->SetRepresentation(looks_);
  widget_->SetAnimationModeToJump();
  vtkNew<vtkCallbackCommand> dragged;
  dragged->SetClientData(this);
  dragged->SetCallback([](vtkObject*, unsigned long, void* self_data, void*) {
    auto& self = *static_cast<Scrubber*>(self_data);
    self.on_drag_(static_cast<std::size_t>(std::lround(self.looks_->GetValue())));
  });
  widget_->AddObserver(vtkCommand::InteractionEvent, dragged);
}

void Scrubber::Show(std::size_t place,
                    std::size_t first,
                    std::size_t last,
                    const Background& background) {
  if (first >= last) {
    widget_->EnabledOff();
    return;
  }
  const auto words = VtkColor(background.words);
  looks_->GetTubeProperty()->SetColor(0.5, 0.5, 0.5);
  looks_->GetSliderProperty()->SetColor(words[0], words[1], words[2]);
  looks_->SetMinimumValue(static_cast<double>(first));
  looks_->SetMaximumValue(static_cast<double>(last));
  looks_->SetValue(static_cast<double>(place));
  // Without this the slider is drawn in whichever view the mouse is over.
  widget_->SetCurrentRenderer(&renderer_);
  widget_->EnabledOn();
}

}  // namespace railcast
