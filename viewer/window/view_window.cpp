#include "viewer/window/view_window.h"

#include <vtkCallbackCommand.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <cstdio>
#include <filesystem>
#include <utility>

#include "viewer/picture/pictures.h"
#include "viewer/window/key_table.h"
#include "viewer/window/point_under.h"

namespace railcast {

ViewWindow::ViewWindow(Session& session, LiveFrames* live, Stage& stage, const Look& look)
    : session_(session),
      live_(live),
      stage_(stage),
      look_(look),
      traces_(session.num_sources()),
      style_(vtkSmartPointer<ViewStyle>::New()) {
  style_->on_key = [this](const std::string& key) { Guard([&] { OnKey(key); }); };
  style_->on_click = [this](const std::array<int, 2>& place_px, bool with_shift) {
    Guard([&] { OnClick(place_px, with_shift); });
  };
}

ViewWindow::~ViewWindow() = default;

void ViewWindow::Guard(const std::function<void()>& action) {
  try {
    action();
  } catch (...) {
    fault_ = std::current_exception();
    interactor_->TerminateApp();
  }
}

double ViewWindow::Now_s() const {
  return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

std::string ViewWindow::KeysText() {
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

void ViewWindow::Run() {
  constexpr unsigned long kPeriod_ms = 16;
  interactor_->SetInteractorStyle(style_);
  interactor_->SetRenderWindow(&stage_.window());
  interactor_->Initialize();
  scrubber_ = std::make_unique<Scrubber>(
      *interactor_, [this](std::size_t place) { Guard([&] { SeekTo(place); }); });
  vtkNew<vtkCallbackCommand> tick;
  tick->SetClientData(this);
  tick->SetCallback([](vtkObject*, unsigned long, void* self_data, void*) {
    auto& self = *static_cast<ViewWindow*>(self_data);
    self.Guard([&self] { self.OnTimer(); });
  });
  interactor_->AddObserver(vtkCommand::TimerEvent, tick);
  vtkNew<vtkCallbackCommand> resized;
  resized->SetClientData(this);
  resized->SetCallback([](vtkObject*, unsigned long, void* self_data, void*) {
    auto& self = *static_cast<ViewWindow*>(self_data);
    self.Guard([&self] { self.Refresh(); });
  });
  interactor_->AddObserver(vtkCommand::ConfigureEvent, resized);
  interactor_->CreateRepeatingTimer(kPeriod_ms);
  player_.Seek(session_.place(), Now_s());
  if (live_ != nullptr) player_.Play(Now_s());
  Guard([this] { Refresh(); });
  if (!fault_) interactor_->Start();
  if (fault_) std::rethrow_exception(fault_);
}

void ViewWindow::OnTimer() {
  if (live_ != nullptr) {
    if (live_->Poll() && player_.is_playing()) {
      NoteFrame();
      SeekTo(live_->num_known() - 1);
    }
  } else if (player_.Advance(Now_s(), session_.Period_s())) {
    const std::size_t place = player_.place();
    if (!session_.Seek(place)) {
      // The end: its last frame stays.
      player_.Pause();
      (void)session_.Seek(session_.LastPlace());
      player_.Seek(session_.place(), Now_s());
    }
    NoteFrame();
    Refresh();
  }
  if (picks_.is_empty() || !traces_[picked_source_]) return;
  if (auto answer = traces_[picked_source_]->Take()) {
    stage_.ShowPlate(Stage::Plate::kTrace, *answer);
    interactor_->Render();
  }
}

void ViewWindow::SeekTo(std::size_t place) {
  if (!session_.Seek(place)) return;
  player_.Seek(session_.place(), Now_s());
  Refresh();
}

void ViewWindow::Step(std::ptrdiff_t num_frames) {
  player_.Pause();
  const auto target = static_cast<std::ptrdiff_t>(session_.place()) + num_frames;
  if (!session_.Seek(static_cast<std::size_t>(std::max<std::ptrdiff_t>(target, 0)))) {
    (void)session_.Seek(session_.LastPlace());
  }
  player_.Seek(session_.place(), Now_s());
  Refresh();
}

void ViewWindow::TogglePlaying() {
  if (player_.is_playing()) {
    player_.Pause();
  } else {
    // From the end it begins anew.
    if (live_ == nullptr && !session_.Seek(session_.place() + 1)) (void)session_.Seek(0);
    player_.Seek(session_.place(), Now_s());
    player_.Play(Now_s());
  }
  Refresh();
}

void ViewWindow::Toggle(bool& choice) {
  choice = !choice;
  Refresh();
}

void ViewWindow::LookFrom(std::string_view preset) {
  stage_.UseCamera(std::string(preset));
  Refresh();
}

void ViewWindow::NoteFrame() {
  frame_times_s_.push_back(Now_s());
  while (frame_times_s_.back() - frame_times_s_.front() > 1.0) frame_times_s_.pop_front();
}

std::string ViewWindow::PlayText() const {
  if (live_ != nullptr) {
    std::string text = live_->StatusText();
    if (!player_.is_playing()) text += "   paused";
    return text;
  }
  std::array<char, 128> text{};
  std::snprintf(text.data(), text.size(), "%zu of %zu   %s x%g", session_.place() + 1,
                session_.source(0).num_known(), player_.is_playing() ? "playing" : "paused",
                player_.speed_factor());
  std::string words = text.data();
  if (player_.is_playing() && frame_times_s_.size() > 1) {
    const double elapsed_s = frame_times_s_.back() - frame_times_s_.front();
    std::snprintf(text.data(), text.size(), "   %.1f frames/s",
                  static_cast<double>(frame_times_s_.size() - 1) / elapsed_s);
    words += text.data();
  }
  return words + "   ? for keys";
}

void ViewWindow::Refresh() {
  std::vector<Scene> scenes = session_.Compose();
  if (!session_.has_frame()) scenes.front().status = "waiting for the first frame";
  scenes.front().status += '\n';
  scenes.front().status += PlayText();
  const bool has_pose = session_.has_frame() && session_.shown(0)->recorded->has_pose;
  if (has_pose) {
    const Transform& world_from_view = session_.shown(0)->frame().world_from_sensor;
    if (!rides_along_) stage_.MoveCamera(world_from_view.inverse() * world_from_view_);
    world_from_view_ = world_from_view;
  }
  stage_.Show(std::move(scenes), look_);
  scrubber_->Show(session_.place(), session_.source(0).num_known(), look_.background);
  stage_.ShowPlate(Stage::Plate::kHelp, shows_help_ ? KeysText() : std::string());
  RefreshMarks();
}

void ViewWindow::RefreshMarks() {
  stage_.ShowPlate(Stage::Plate::kFacts, picks_.facts());
  for (std::size_t i = 0; i < stage_.num_views(); ++i) {
    stage_.ShowMarks(i, picks_.MarksIn(stage_.view(i).scene()));
  }
  interactor_->Render();
}

void ViewWindow::OnClick(const std::array<int, 2>& place_px, bool with_shift) {
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
  stage_.ShowPlate(Stage::Plate::kTrace, {});
  RefreshMarks();
}

void ViewWindow::SelectInLegend(const Legend::Line& line) {
  if (session_.choices().color_by != "label") return;
  session_.ToggleLabel(static_cast<std::uint32_t>(line.value));
  Refresh();
}

void ViewWindow::SelectPickedLabel() {
  if (const auto label = picks_.label()) {
    session_.ToggleLabel(*label);
    Refresh();
  }
}

void ViewWindow::ClearSelection() {
  session_.choices().labels.clear();
  picks_.Clear();
  stage_.ShowPlate(Stage::Plate::kTrace, {});
  Refresh();
}

void ViewWindow::AskTrace() {
  if (picks_.is_empty()) return;
  auto& trace = traces_[picked_source_];
  if (!trace) trace = std::make_unique<EffectTrace>(session_.source(picked_source_).info());
  trace->Ask(picks_.recorded(), picks_.slot());
  stage_.ShowPlate(Stage::Plate::kTrace, "tracing ...");
  interactor_->Render();
}

void ViewWindow::SaveScreenshot() {
  std::string file;
  for (int number = 1; file.empty() || std::filesystem::exists(file); ++number) {
    file = "railcast-view-";
    file += std::to_string(number);
    file += ".png";
  }
  WritePicture(stage_.window(), file);
  std::fprintf(stderr, "wrote %s\n", file.c_str());
}

void ViewWindow::OnKey(const std::string& key) {
  const auto bindings = KeyTable::Bindings();
  const auto found = std::ranges::find(bindings, key, &KeyBinding::symbol);
  if (found == bindings.end() || found->action == nullptr) return;
  if (!session_.has_frame() && key != "q" && key != "question") return;
  found->action(*this);
}

}  // namespace railcast
