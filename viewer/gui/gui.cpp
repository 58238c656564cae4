#include "viewer/gui/gui.h"

#include <vtkCamera.h>
#include <vtkCommand.h>
#include <vtkObjectFactory.h>
#include <vtkProperty2D.h>
#include <vtkTextProperty.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <numbers>
#include <utility>

#include "core/base/error.h"
#include "core/base/text.h"
#include "railcast/transform.h"
#include "viewer/draw/vtk_values.h"
#include "viewer/pick/point_under.h"
#include "viewer/picture/pictures.h"

namespace railcast {
namespace {

double Now_s() {
  return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

}  // namespace

vtkStandardNewMacro(ViewStyle);

void ViewStyle::OnKeyPress() {
  if (on_key) on_key(Interactor->GetKeySym() == nullptr ? "" : Interactor->GetKeySym());
}

void ViewStyle::OnLeftButtonDown() {
  const int* const place = Interactor->GetEventPosition();
  pressed_at_px_ = {place[0], place[1]};
  vtkInteractorStyleTrackballCamera::OnLeftButtonDown();
}

void ViewStyle::OnLeftButtonUp() {
  constexpr int kStill_px = 3;
  vtkInteractorStyleTrackballCamera::OnLeftButtonUp();
  const int* const place = Interactor->GetEventPosition();
  const int moved_px =
      std::max(std::abs(place[0] - pressed_at_px_[0]), std::abs(place[1] - pressed_at_px_[1]));
  if (moved_px > kStill_px || !on_click) return;
  on_click({place[0], place[1]}, Interactor->GetShiftKey() != 0);
}

// The camera turns in azimuth and elevation about the target. Where it looks straight down, the
// azimuth follows from the direction that is up on the screen.
void ViewStyle::Rotate() {
  if (CurrentRenderer == nullptr) return;
  vtkCamera* const camera = CurrentRenderer->GetActiveCamera();
  const Vector3 target_m(camera->GetFocalPoint());
  const Vector3 offset_m = Vector3(camera->GetPosition()) - target_m;
  const Vector3 up(camera->GetViewUp());
  const double level_m = offset_m.head<2>().norm();
  double azimuth_rad = std::atan2(offset_m.y(), offset_m.x());
  if (level_m < 1e-6 * offset_m.norm()) azimuth_rad = std::atan2(-up.y(), -up.x());
  double elevation_rad = std::atan2(offset_m.z(), level_m);

  const int* const now = Interactor->GetEventPosition();
  const int* const before = Interactor->GetLastEventPosition();
  const int* const size_px = CurrentRenderer->GetSize();
  azimuth_rad -= 2.0 * std::numbers::pi * (now[0] - before[0]) / std::max(1, size_px[0]);
  elevation_rad -= std::numbers::pi * (now[1] - before[1]) / std::max(1, size_px[1]);
  elevation_rad = std::clamp(elevation_rad, -0.5 * std::numbers::pi, 0.5 * std::numbers::pi);

  const Vector3 outward(std::cos(elevation_rad) * std::cos(azimuth_rad),
                        std::cos(elevation_rad) * std::sin(azimuth_rad), std::sin(elevation_rad));
  const Vector3 eye_m = target_m + offset_m.norm() * outward;
  const Vector3 new_up(-std::sin(elevation_rad) * std::cos(azimuth_rad),
                       -std::sin(elevation_rad) * std::sin(azimuth_rad), std::cos(elevation_rad));
  camera->SetPosition(eye_m.data());
  camera->SetViewUp(new_up.data());
  CurrentRenderer->ResetCameraClippingRange();
  Interactor->Render();
}

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
  widget_->AddObserver(vtkCommand::InteractionEvent, this, &Scrubber::OnDrag);
}

void Scrubber::OnDrag() {
  on_drag_(static_cast<std::size_t>(std::lround(looks_->GetValue())));
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

Gui::Gui(Session& session, LiveFrames* live, Stage& stage, const Look& look)
    : session_(session),
      stage_(stage),
      look_(look),
      playback_(session, live),
      tracing_(session.num_sources()),
      style_(vtkSmartPointer<ViewStyle>::New()) {
  style_->on_key = [this](const std::string& key) { Guard([&] { OnKey(key); }); };
  style_->on_click = [this](const std::array<int, 2>& place_px, bool with_shift) {
    Guard([&] { OnClick(place_px, with_shift); });
  };
}

Gui::~Gui() = default;

void Gui::Guard(const std::function<void()>& action) {
  try {
    action();
  } catch (const InputError& error) {
    message_ = error.what();
    ShowStatus();
  } catch (...) {
    fault_ = std::current_exception();
    interactor_->TerminateApp();
  }
}

std::string Gui::KeysText() {
  std::string text;
  for (const KeyBinding& binding : KeyTable::Bindings()) {
    if (binding.shown.empty()) continue;
    std::array<char, 128> line{};
    std::snprintf(line.data(), line.size(), "  %-15s%s\n", std::string(binding.shown).c_str(),
                  std::string(binding.help).c_str());
    text += line.data();
  }
  return text;
}

void Gui::Run() {
  constexpr unsigned long kPeriod_ms = 16;
  interactor_->SetInteractorStyle(style_);
  interactor_->SetRenderWindow(&stage_.window());
  interactor_->Initialize();
  scrubber_ =
      std::make_unique<Scrubber>(*interactor_, stage_.plates_renderer(),
                                 [this](std::size_t place) { Guard([&] { SeekTo(place); }); });
  interactor_->AddObserver(vtkCommand::TimerEvent, this, &Gui::Guarded<&Gui::OnTimer>);
  interactor_->AddObserver(vtkCommand::ConfigureEvent, this, &Gui::Guarded<&Gui::Redraw>);
  interactor_->CreateRepeatingTimer(kPeriod_ms);
  playback_.Begin(Now_s());
  Guard([this] { Refresh(); });
  if (!fault_) interactor_->Start();
  if (fault_) std::rethrow_exception(fault_);
}

void Gui::OnTimer() {
  constexpr double kStatusPeriod_s = 0.5;
  const double now_s = Now_s();
  const bool has_changed = playback_.Advance(now_s);
  if (has_changed) Refresh();
  if (const auto answer = tracing_.Take()) {
    stage_.ShowPlate(Stage::Plate::kTrace, *answer);
    interactor_->Render();
  }
  // The status also changes without a new frame: a live stream may stop, and a capture's frames are
  // still being counted.
  if (!has_changed && now_s > status_at_s_ + kStatusPeriod_s) ShowStatus();
}

void Gui::SeekTo(std::size_t place) {
  playback_.SeekTo(place, Now_s());
  Refresh();
}

void Gui::Step(std::ptrdiff_t num_frames) {
  playback_.Step(num_frames, Now_s());
  Refresh();
}

void Gui::TogglePlaying() {
  playback_.TogglePlaying(Now_s());
  Refresh();
}

void Gui::ChangeSpeed(bool faster) {
  faster ? playback_.Faster(Now_s()) : playback_.Slower(Now_s());
  ShowStatus();
}

void Gui::Toggle(bool& choice) {
  choice = !choice;
  Refresh();
}

// Begins with a map other than the default, so that the first press shows a change.
void Gui::NextMap() {
  auto& map = session_.choices().map;
  if (map == ColorMap::kViridis) {
    map.reset();
  } else {
    const std::size_t at = map ? static_cast<std::size_t>(*map) : 0;
    map = static_cast<ColorMap>((at + 1) % kColorMapNames.size());
  }
  Refresh();
}

void Gui::NextBackground() {
  const auto* const at = std::ranges::find(kBackgrounds, look_.background.name, &Background::name);
  look_.background = at + 1 == kBackgrounds.end() ? kBackgrounds[0] : at[1];
  Redraw();
}

void Gui::ChangePointSize(int by_px) {
  look_.point_size_px = std::clamp(look_.point_size_px + by_px, 1, kMaxPointSize_px);
  Redraw();
}

void Gui::LookFrom(std::string_view preset) {
  stage_.UseCamera(std::string(preset));
  interactor_->Render();
}

void Gui::TurnAboutPick() {
  const auto target_m = picks_.PlaceIn(stage_.view(0).composition());
  if (!target_m) return;
  stage_.TurnAbout(*target_m);
  interactor_->Render();
}

void Gui::Refresh() {
  std::vector<Composition> compositions = session_.Compose();
  if (!session_.has_frame()) compositions.front().status = "waiting for the first frame";
  scene_status_ = compositions.front().status;
  const bool has_pose = session_.has_frame() && session_.shown(0)->recorded->has_pose;
  if (has_pose) {
    const Transform& world_from_view = session_.shown(0)->frame().world_from_sensor;
    if (!rides_along_) stage_.MoveCamera(world_from_view.inverse() * world_from_view_);
    world_from_view_ = world_from_view;
  }
  stage_.Show(std::move(compositions), look_);
  ShowRest();
}

void Gui::Redraw() {
  stage_.Redraw(look_);
  ShowRest();
}

void Gui::ShowRest() {
  stage_.ShowPlate(Stage::Plate::kHelp, shows_help_ ? KeysText() : std::string());
  stage_.ShowPlate(Stage::Plate::kFacts, picks_.facts());
  for (std::size_t i = 0; i < stage_.num_views(); ++i) {
    stage_.ShowMarks(i, picks_.MarksIn(stage_.view(i).composition()));
  }
  ShowStatus();
}

void Gui::ShowStatus() {
  std::string status = scene_status_;
  for (const std::string& line :
       {playback_.StatusText() + "   ? for keys", playback_.fault(), message_}) {
    if (line.empty()) continue;
    status += '\n';
    status += line;
  }
  stage_.ShowStatus(status);
  scrubber_->Show(session_.place(), session_.FirstPlace(), session_.LastPlace(), look_.background);
  status_at_s_ = Now_s();
  interactor_->Render();
}

void Gui::OnClick(const std::array<int, 2>& place_px, bool with_shift) {
  message_.clear();
  const std::size_t index = stage_.ViewAt(place_px[0]);
  const auto in_view_px = stage_.InView(index, place_px[0], place_px[1]);
  if (const auto line = stage_.view(index).legend().LineAt(in_view_px)) {
    SelectInLegend(*line);
    return;
  }
  const auto hit = PointUnder(stage_, session_, place_px);
  if (!hit) return;
  picked_source_ = hit->source;
  picks_.Add(*hit->shown, hit->point, session_.source(hit->source).info(), with_shift);
  tracing_.Forget();
  stage_.ShowPlate(Stage::Plate::kTrace, {});
  ShowRest();
}

void Gui::SelectInLegend(const Legend::Line& line) {
  const Choices& choices = session_.choices();
  if (choices.color_by != "label" || choices.layout == Layout::kChanges) return;
  session_.ToggleLabel(static_cast<std::uint32_t>(line.value));
  Refresh();
}

void Gui::SelectPickedLabel() {
  if (const auto label = picks_.label()) {
    session_.ToggleLabel(*label);
    Refresh();
  }
}

void Gui::ClearSelection() {
  session_.choices().labels.clear();
  picks_.Clear();
  tracing_.Forget();
  stage_.ShowPlate(Stage::Plate::kTrace, {});
  Refresh();
}

void Gui::AskTrace() {
  if (picks_.is_empty()) return;
  tracing_.Ask(picked_source_, session_.source(picked_source_).info(), picks_.recorded(),
               picks_.slot());
  stage_.ShowPlate(Stage::Plate::kTrace, "tracing ...");
  interactor_->Render();
}

void Gui::SaveScreenshot() {
  std::string file;
  for (int number = 1; file.empty() || std::filesystem::exists(file); ++number) {
    file = "railcast-view-";
    file += std::to_string(number);
    file += ".png";
  }
  WritePicture(stage_.window(), file);
  std::fprintf(stderr, "wrote %s\n", ShownPath(file).c_str());
}

void Gui::OnKey(const std::string& key) {
  message_.clear();
  const auto bindings = KeyTable::Bindings();
  const auto found = std::ranges::find(bindings, key, &KeyBinding::symbol);
  if (found == bindings.end() || found->action == nullptr) return;
  if (!session_.has_frame() && key != "q" && key != "question") return;
  found->action(*this);
}

}  // namespace railcast
