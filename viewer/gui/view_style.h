#pragma once

#include <vtkInteractorStyleTrackballCamera.h>

#include <array>
#include <functional>
#include <string>

namespace railcast {

/// What mouse and keyboard do in a view. Dragging with the left button turns the camera about the
/// target with z staying up, with the middle button (or shift and left) it moves the camera, and
/// with the right button it zooms, as does the wheel. A press without a drag is a click. VTK's own
/// keys are disabled.
class ViewStyle : public vtkInteractorStyleTrackballCamera {
 public:
  static ViewStyle* New();
  vtkTypeMacro(ViewStyle, vtkInteractorStyleTrackballCamera)

      /// Called with a place in the window, in pixels from its lower left corner.
      std::function<void(const std::array<int, 2>& place_px, bool with_shift)> on_click;
  /// Called with VTK's name of the key: "space", "Right", "a", "A", "question".
  std::function<void(const std::string& key)> on_key;

  void OnChar() override {}
  /// VTK's own timer keeps turning the camera while a button is held, even if the mouse rests.
  void OnTimer() override {}
  void OnKeyPress() override;
  void OnLeftButtonDown() override;
  void OnLeftButtonUp() override;
  void Rotate() override;

 protected:
  ViewStyle() = default;

 private:
  std::array<int, 2> pressed_at_px_{};
};

}  // namespace railcast
