#pragma once

#include <vtkInteractorStyleTrackballCamera.h>

#include <array>
#include <functional>
#include <string>

namespace railcast {

/// What the mouse and the keyboard do in a view: dragging turns about the target with z staying up
/// (left), moves (middle, or shift and left) or zooms (right; the wheel, too); what is not a drag
/// is a click. VTK's own keys do nothing.
class ViewStyle : public vtkInteractorStyleTrackballCamera {
 public:
  static ViewStyle* New();
  vtkTypeMacro(ViewStyle, vtkInteractorStyleTrackballCamera)

      /// A place in the window, in pixels from its lower left corner.
      std::function<void(const std::array<int, 2>& place_px, bool with_shift)> on_click;
  /// VTK's name of the key: "space", "Right", "a", "A", "question".
  std::function<void(const std::string& key)> on_key;

  void OnChar() override {}
  /// VTK's goes on turning as long as a button is held, also where the mouse rests.
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
