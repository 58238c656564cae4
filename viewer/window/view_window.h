#pragma once

#include <vtkNew.h>
#include <vtkRenderWindowInteractor.h>
#include <vtkSmartPointer.h>

#include <array>
#include <cstddef>
#include <exception>
#include <functional>
#include <memory>
#include <string>
#include <string_view>

#include "viewer/draw/stage.h"
#include "viewer/frames/live_frames.h"
#include "viewer/session/picks.h"
#include "viewer/session/playback.h"
#include "viewer/session/session.h"
#include "viewer/session/tracing.h"
#include "viewer/window/scrubber.h"
#include "viewer/window/view_style.h"

namespace railcast {

/// The interactive window: what mouse and keys do to a session, its playback and its picks, and
/// when that is drawn.
class ViewWindow {
 public:
  /// @param live The session's source if it is a live one, else null.
  ViewWindow(Session& session, LiveFrames* live, Stage& stage, const Look& look);
  ~ViewWindow();
  ViewWindow(const ViewWindow&) = delete;
  ViewWindow& operator=(const ViewWindow&) = delete;

  /// Shows it until the user closes it. What cannot be read or written is said in the window.
  /// @throws Whatever else goes wrong; the window is closed then.
  void Run();

  /// Keys and what they do, as `?` and --help list them.
  [[nodiscard]] static std::string KeysText();

 private:
  friend struct KeyTable;

  void OnTimer();
  void OnClick(const std::array<int, 2>& place_px, bool with_shift);
  void OnKey(const std::string& key);
  /// Does it. No exception may pass VTK's event loop: an InputError is shown, others are kept for
  /// Run().
  void Guard(const std::function<void()>& action);

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

  /// Makes everything anew from the session.
  void Refresh();
  /// The same scenes with another look or size.
  void Redraw();
  /// What belongs to the window and not to a scene: status, slider, plates, marks.
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
  std::string message_;   ///< What went wrong last.
  double status_at_s_{};  ///< When the status was drawn last.
  std::string scene_status_;
  Transform world_from_view_ = Transform::Identity();
  vtkNew<vtkRenderWindowInteractor> interactor_;
  vtkSmartPointer<ViewStyle> style_;
  std::unique_ptr<Scrubber> scrubber_;
  std::exception_ptr fault_;
};

}  // namespace railcast
