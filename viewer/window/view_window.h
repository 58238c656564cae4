#pragma once

#include <vtkNew.h>
#include <vtkRenderWindowInteractor.h>
#include <vtkSmartPointer.h>

#include <array>
#include <cstdint>
#include <deque>
#include <exception>
#include <functional>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "viewer/draw/stage.h"
#include "viewer/frames/live_frames.h"
#include "viewer/pick/effect_trace.h"
#include "viewer/session/picks.h"
#include "viewer/session/player.h"
#include "viewer/session/session.h"
#include "viewer/window/scrubber.h"
#include "viewer/window/view_style.h"

namespace railcast {

/// The interactive window.
class ViewWindow {
 public:
  /// @param live The session's source if it is a live one, else null.
  ViewWindow(Session& session, LiveFrames* live, Stage& stage, const Look& look);
  ~ViewWindow();
  ViewWindow(const ViewWindow&) = delete;
  ViewWindow& operator=(const ViewWindow&) = delete;

  /// Shows it until the user closes it.
  /// @throws What drawing or reading throws; the window is closed then.
  void Run();

  /// Keys and what they do, as `?` and --help list them.
  [[nodiscard]] static std::string KeysText();

 private:
  friend struct KeyTable;

  void OnTimer();
  void OnClick(const std::array<int, 2>& place_px, bool with_shift);
  void OnKey(const std::string& key);
  /// Does it and keeps what it throws for Run(): no exception may pass VTK's event loop.
  void Guard(const std::function<void()>& action);

  [[nodiscard]] double Now_s() const;
  void SeekTo(std::size_t place);
  void Step(std::ptrdiff_t num_frames);
  void TogglePlaying();
  /// Makes everything anew from the session.
  void Refresh();
  void RefreshMarks();
  /// Notes that another frame is shown.
  void NoteFrame();
  [[nodiscard]] std::string PlayText() const;
  void Toggle(bool& choice);
  void LookFrom(std::string_view preset);
  void SelectInLegend(const Legend::Line& line);
  void SelectPickedLabel();
  void ClearSelection();
  void AskTrace();
  void SaveScreenshot();

  Session& session_;
  LiveFrames* live_;
  Stage& stage_;
  Look look_;
  Player player_;
  Picks picks_;
  std::vector<std::unique_ptr<EffectTrace>> traces_;  ///< By source; made when first asked.
  std::deque<double> frame_times_s_;  ///< When the last frames were shown, a second back.
  std::size_t picked_source_{};
  bool rides_along_ = true;
  bool shows_help_ = false;
  Transform world_from_view_ = Transform::Identity();
  vtkNew<vtkRenderWindowInteractor> interactor_;
  vtkSmartPointer<ViewStyle> style_;
  std::unique_ptr<Scrubber> scrubber_;
  std::exception_ptr fault_;
};

}  // namespace railcast
