#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <memory>
#include <thread>
#include <utility>

#include "core/base/error.h"
#include "core/base/text.h"
#include "core/io/recording/source_choice.h"
#include "core/io/run/run_folder.h"
#include "core/program/command_line.h"
#include "core/program/program.h"
#include "core/program/progress_line.h"
#include "railcast/scenario.h"
#include "viewer/draw/stage.h"
#include "viewer/frames/frames.h"
#include "viewer/frames/live_frames.h"
#include "viewer/gui/gui.h"
#include "viewer/options.h"
#include "viewer/pick/effect_trace.h"
#include "viewer/pick/picks.h"
#include "viewer/pick/point_under.h"
#include "viewer/picture/pictures.h"
#include "viewer/plan/draw_plan.h"
#include "viewer/session/session.h"

namespace railcast {
namespace {

/// Returns the labels named by --select.
/// @throws InputError if the recording knows no such label.
std::set<std::uint32_t> SelectedLabels(const std::vector<std::string>& names,
                                       const LabelTable& labels) {
  std::set<std::uint32_t> ids;
  for (const std::string& name : names) {
    const Label* const label = labels.Find(name);
    if (label == nullptr) {
      throw InputError("--select: must be labels of the recording (got " + ShownText(name) + ")");
    }
    ids.insert(label->id);
  }
  return ids;
}

/// Waits for a whole frame of a live source and returns its place.
/// @param first The first place that counts.
/// @param with_picture Whether to wait for the frame's picture, too.
std::size_t WaitForFrame(LiveFrames& live, std::size_t first, bool with_picture, double wait_s) {
  using Clock = std::chrono::steady_clock;
  const auto end = Clock::now() + std::chrono::duration<double>(wait_s);
  while (true) {
    (void)live.Poll();
    (void)live.PollImages();
    if (!live.fault().empty()) throw InputError(live.fault());
    if (const auto place = live.FirstWhole(first, with_picture)) return *place;
    if (Clock::now() > end) {
      throw InputError(ShownPath(live.info().source) + ": no whole frame " +
                       (with_picture ? "with an image " : "") + "came within " +
                       NumberText(wait_s) + " s");
    }
    std::this_thread::sleep_for(std::chrono::milliseconds(5));
  }
}

/// Prints what is known of the points given by --pick, and shows it in the picture.
void ShowPicks(const ViewOptions& options, const Session& session, Stage& stage) {
  Picks picks;
  std::size_t source = 0;
  for (const auto& [x_px, y_px] : options.picks_px) {
    // Pixels of a picture are counted from its top, those of the window from its bottom.
    const auto hit = PointUnder(stage, session, {x_px, options.size_px[1] - 1 - y_px});
    if (!hit) {
      throw InputError("--pick: no point is near " + NumberText(x_px) + "," + NumberText(y_px));
    }
    source = hit->source;
    picks.Add(*hit->shown, hit->point, session.source(source).info(), true);
  }
  if (picks.is_empty()) return;
  stage.ShowPlate(Stage::Plate::kFacts, picks.facts());
  std::printf("%s%s", ShownLines(picks.facts()).c_str(), picks.facts().ends_with('\n') ? "" : "\n");
  for (std::size_t i = 0; i < stage.num_views(); ++i) {
    stage.ShowMarks(i, picks.MarksIn(stage.view(i).composition()));
  }
  if (!options.traces) return;
  const std::string trace =
      EffectTrace(session.source(source).info()).Of(*picks.recorded(), picks.slot());
  stage.ShowPlate(Stage::Plate::kTrace, trace);
  std::printf("\n%s", ShownLines(trace).c_str());
}

class Viewer {
 public:
  explicit Viewer(const ViewOptions& options)
      : options_(options), session_(OpenSession()), stage_(options.size_px) {
    if (options.place) {
      stage_.UseCamera(*options.place);
    } else if (!options.camera.empty()) {
      stage_.UseCamera(options.camera);
    } else {
      // The other presets are made for sensors on rail vehicles.
      const bool is_ours = live_ || session_->source(0).info().scenario;
      stage_.UseCamera(is_ours ? "chase" : "all");
    }
  }

  void Run() {
    if (live_) SayWhereItListens();
    if (live_ && options_.is_headless()) SeekFirst(*session_);
    if (!options_.screenshot.empty()) {
      DrawOffScreen();
      ShowPicks(options_, *session_, stage_);
      WritePicture(stage_.window(), options_.screenshot);
    } else if (!options_.video.empty()) {
      RecordVideo();
    } else {
      Gui(*session_, live_.get(), stage_, options_.look).Run();
    }
  }

 private:
  /// Opens the sources, of which recordings have shown their first frame.
  std::unique_ptr<Session> OpenSession() {
    if (options_.is_live()) OpenLive();
    SourceChoice choice = options_.choice;
    if (IsOfCapture()) choice.sensor = *options_.sensor;
    for (const auto& source : WithChoice({options_.source, options_.compare}, choice)) {
      if (source.empty() || options_.is_live()) continue;
      recorded_.push_back(std::make_unique<RecordedFrames>(source));
      UseScenario(*recorded_.back());
    }
    std::vector<Frames*> frames;
    if (live_) frames.push_back(live_.get());
    for (const auto& each : recorded_) frames.push_back(each.get());
    Choices choices = options_.choices;
    choices.labels = SelectedLabels(options_.select, frames.front()->info().labels);
    auto session = std::make_unique<Session>(frames, std::move(choices));
    if (!live_) SeekFirst(*session);
    return session;
  }

  void OpenLive() {
    const std::string address = options_.source.string().substr(kLivePrefix.size());
    // Packets name a sensor by its index in the scenario.
    WantedStream wanted;
    if (options_.sensor) {
      const std::vector<std::string> names = SensorNames(Scenario());
      const auto found = std::ranges::find(names, *options_.sensor);
      if (found != names.end()) wanted.sensor = static_cast<std::uint16_t>(found - names.begin());
    }
    if (options_.from) {
      wanted.from = AtPlace("--from: ", [&] { return ParseEndpoint(*options_.from, 0); });
    }
    const Endpoint at = ParseEndpoint(address, kStreamPort);
    std::optional<Endpoint> images_at;
    if (options_.image_port) images_at = Endpoint{at.address, *options_.image_port};
    live_ = std::make_unique<LiveFrames>(options_.source.string(), at, wanted, images_at);
    UseScenario(*live_);
  }

  void SayWhereItListens() const {
    std::fprintf(stderr, "listening at %s\n", EndpointText(live_->at()).c_str());
    const auto images_at = live_->images_at();
    if (!images_at) return;
    std::fprintf(stderr, "listening for images at %s\n", EndpointText(*images_at).c_str());
  }

  template <typename Source>
  void UseScenario(Source& source) {
    if (options_.scenario.empty()) return;
    source.UseScenario(PickSensor(Scenario(), IsOfCapture() ? std::nullopt : options_.sensor));
  }

  /// Whether --sensor names one of a capture.
  [[nodiscard]] bool IsOfCapture() const {
    return options_.sensor && ParseSender(*options_.sensor);
  }

  /// Returns the scenario of --scenario, which is read at the first call.
  const ScenarioSpec& Scenario() {
    if (!scenario_) scenario_ = ReadScenario(options_.scenario);
    return *scenario_;
  }

  void SeekFirst(Session& session) {
    std::size_t place = session.FirstPlace();
    if (live_) place = NextLivePlace(0);
    if (options_.frame) place = recorded_.front()->PlaceOf(*options_.frame);
    if (!session.Seek(place)) {
      throw InputError(ShownPath(options_.source) + ": has no frame to show");
    }
    const std::string missing = session.Missing();
    if (!missing.empty()) throw InputError(ShownPath(options_.source) + ": " + missing);
    if (options_.is_verbose) {
      for (const Composition& composition : session.Compose()) {
        std::fprintf(stderr, "%s\n", ShownLines(composition.status).c_str());
      }
    }
  }

  void DrawOffScreen() {
    stage_.window().SetOffScreenRendering(true);
    std::vector<Composition> compositions = session_->Compose();
    for (const Composition& composition : compositions) {
      if (!composition.picture_fault.empty()) throw InputError(composition.picture_fault);
    }
    if (live_) {
      compositions.front().status += '\n';
      compositions.front().status += live_->StatusText();
    }
    stage_.Show(std::move(compositions), options_.look);
    stage_.window().Render();
  }

  /// Goes to the next frame, if there is one; waits for it if the source is live.
  bool SeekNext() {
    const std::size_t next = session_->place() + 1;
    return session_->Seek(live_ ? NextLivePlace(next) : next);
  }

  std::size_t NextLivePlace(std::size_t first) {
    const bool with_picture = live_->images_at() && options_.choices.picture != PictureKind::kOff;
    return WaitForFrame(*live_, first, with_picture, options_.wait_s);
  }

  void ShowProgress(std::size_t num_pictures, const ProgressLine& line) const {
    const std::string what = NumberText(num_pictures) + " pictures";
    // The number of frames is unknown for captures and live sources.
    const auto& num_frames = session_->source(0).info().num_frames;
    std::optional<std::size_t> num_all = options_.num_pictures;
    if (num_frames) {
      const std::size_t num_left = *num_frames - session_->place() - 1 + num_pictures;
      num_all = std::min(num_all.value_or(num_left), num_left);
    }
    if (num_all) {
      line.Show(what, static_cast<double>(num_pictures) / static_cast<double>(*num_all));
    } else {
      line.Show(what);
    }
  }

  void RecordVideo() {
    PictureFolder folder(options_.video);
    const ProgressLine line;
    do {
      DrawOffScreen();
      folder.Add(stage_.window());
      ShowProgress(folder.num_pictures(), line);
    } while (folder.num_pictures() != options_.num_pictures && SeekNext());
    line.End();
  }

  const ViewOptions& options_;
  std::optional<ScenarioSpec> scenario_;
  std::unique_ptr<LiveFrames> live_;
  std::vector<std::unique_ptr<RecordedFrames>> recorded_;
  std::unique_ptr<Session> session_;
  // Behind what is read, so that faults of that are found on machines without a display, too.
  DisplayConnection display_;
  Stage stage_;
};

void WritePlan(const ViewOptions& options) {
  const ScenarioSpec scenario = ReadScenario(options.source);
  const auto world = MakeWorld(scenario);
  const PlanStretch stretch = ChosenStretch(*world, options.stretch_s_m);
  const DisplayConnection display;
  const std::string title = options.source.filename().string() + ", chainage " +
                            NumberText(std::round(stretch.from_s_m)) + " to " +
                            NumberText(std::round(stretch.to_s_m)) + " m";
  if (options.is_verbose) std::fprintf(stderr, "%s\n", ShownPath(title).c_str());
  const auto window = DrawPlan(MakePlan(scenario, *world, stretch), ShownPath(title),
                               options.look.background, options.size_px);
  WritePicture(*window, options.screenshot);
}

/// Carries out what the command line asks for.
/// @throws InputError with one line if something cannot be read, shown or written.
void RunViewer(const ViewOptions& options) {
  CheckOutputFiles({}, {{"--screenshot", options.screenshot}});
  if (!options.video.empty()) CheckIsOutside("--video", options.video);
  if (options.is_plan()) {
    WritePlan(options);
    return;
  }
  Viewer(options).Run();
}

int RunView(const ViewOptions& options) {
  try {
    RunViewer(options);
  } catch (const InputError& error) {
    throw InputError(std::string("error: ") + error.what());
  }
  return kExitSuccess;
}

void AddView(ProgramOptions& app, ProgramCommand& command) {
  const auto options = std::make_shared<ViewOptions>();
  AddViewOptions(app, *options);
  command = [options](const std::string&) { return RunView(*options); };
}

}  // namespace
}  // namespace railcast

int main(int argc, char** argv) {
  return railcast::ProgramMain(
      {.name = "railcast-view",
       .description = "Shows point clouds, recorded or live, and what is known of them.",
       .footer = "Keys in the window:\n" + railcast::Gui::KeysText(),
       .add = railcast::AddView},
      argc, argv);
}
