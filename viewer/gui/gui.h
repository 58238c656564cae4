#pragma once

#include <vtkInteractorStyleTrackballCamera.h>
#include <vtkNew.h>
#include <vtkRenderWindowInteractor.h>
#include <vtkRenderer.h>
#include <vtkSliderRepresentation2D.h>
#include <vtkSliderWidget.h>
#include <vtkSmartPointer.h>

#include <array>
#include <cstddef>
#include <exception>
#include <functional>
#include <memory>
#include <span>
#include <string>
#include <string_view>

#include "viewer/draw/look.h"
#include "viewer/draw/stage.h"
#include "viewer/frames/live_frames.h"
#include "viewer/pick/effect_trace.h"
#include "viewer/pick/picks.h"
#include "viewer/session/playback.h"
#include "viewer/session/session.h"

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

class Gui;

/// A key and what it does.
struct KeyBinding {
  std::string_view symbol;  ///< X's name of the key: "space", "Right", "A".
  std::string_view shown;   ///< As the help shows it; empty: listed with the line before.
  std::string_view help;
  void (*action)(Gui&);
};

/// All keys, in the order in which `?` lists them.
struct KeyTable {
  [[nodiscard]] static std::span<const KeyBinding> Bindings();
};

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
  void OnDrag();

  vtkRenderer& renderer_;
  std::function<void(std::size_t)> on_drag_;
  vtkNew<vtkSliderRepresentation2D> looks_;
  vtkNew<vtkSliderWidget> widget_;
};

/// The interactive window: what mouse and keyboard do to a session, its playback and its picks, and
/// when the result is drawn.
class Gui {
 public:
  /// @param live The session's source if that is a live one, else null.
  Gui(Session& session, LiveFrames* live, Stage& stage, const Look& look);
  ~Gui();
  Gui(const Gui&) = delete;
  Gui& operator=(const Gui&) = delete;

  /// Shows the window until the user closes it. Faults in reading or writing are shown in the
  /// window.
  /// @throws Any other error, after closing the window.
  void Run();

  /// Returns the keys and what they do, as `?` and --help list them.
  [[nodiscard]] static std::string KeysText();

 private:
  friend struct KeyTable;

  void OnTimer();
  void OnClick(const std::array<int, 2>& place_px, bool with_shift);
  void OnKey(const std::string& key);
  /// Runs an action. No exception may pass through VTK's event loop: an InputError is shown, any
  /// other is kept for Run() to rethrow.
  void Guard(const std::function<void()>& action);
  template <void (Gui::*kAction)()>
  void Guarded() {
    Guard([this] { (this->*kAction)(); });
  }

  void Step(std::ptrdiff_t num_frames);
  void SeekTo(std::size_t place);
  void TogglePlaying();
  void ChangeSpeed(bool faster);
  void Toggle(bool& choice);
  void NextMap();
  void NextBackground();
  void ChangePointSize(int by_px);
  void LookFrom(std::string_view preset);
  void TurnAboutPick();
  void SelectInLegend(const Legend::Line& line);
  void SelectPickedLabel();
  void ClearSelection();
  void AskTrace();
  void SaveScreenshot();

  /// Composes and draws everything again from the session.
  void Refresh();
  /// Draws the same compositions again with another look or size.
  void Redraw();
  /// Draws what belongs to the window and not to a composition: status, slider, plates, marks.
  void ShowRest();
  void ShowStatus();

  Session& session_;
  Stage& stage_;
  Look look_;
  Playback playback_;
  Picks picks_;
  Tracing tracing_;
  std::size_t picked_source_{};
  bool rides_along_ = true;
  bool shows_help_ = false;
  std::string message_;   ///< The last error.
  double status_at_s_{};  ///< Time at which the status was last drawn.
  std::string scene_status_;
  Transform world_from_view_ = Transform::Identity();
  vtkNew<vtkRenderWindowInteractor> interactor_;
  vtkSmartPointer<ViewStyle> style_;
  std::unique_ptr<Scrubber> scrubber_;
  std::exception_ptr fault_;
};

}  // namespace railcast
