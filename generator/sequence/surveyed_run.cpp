#include "generator/sequence/surveyed_run.h"

#include <algorithm>
#include <vector>

#include "generator/run/stop_signal.h"
#include "generator/run/stopping.h"
#include "railcast/scenario.h"

namespace railcast {

SurveyedRun::SurveyedRun(CommandedRun& run,
                         std::size_t sensor,
                         const ScenarioSpec& scenario,
                         const LabelTable& labels)
    : run_(run), sensor_(sensor), labels_(labels), camera_(MakeCamera(scenario)) {
  if (camera_) frames_per_image_ = FramesPerImage(scenario);
}

namespace {

/// A thread other than the one that waits for a window may be the first to see that the run is
/// stopped; then the deadline is still set, which would cut off frames that are being finished.
struct NoDeadlineAfterwards {
  NoDeadlineAfterwards() = default;
  ~NoDeadlineAfterwards() { UseStopDeadline(false); }
  NoDeadlineAfterwards(const NoDeadlineAfterwards&) = delete;
  NoDeadlineAfterwards& operator=(const NoDeadlineAfterwards&) = delete;
};

}  // namespace

FrameJob SurveyedRun::Begin(std::uint32_t index) {
  const NoDeadlineAfterwards guard;
  Simulator& simulator = run_.At(sensor_, index);
  // Frames are begun by whichever thread is free: from now on the terminal shows what this one
  // waits for.
  WatchBuilding(simulator, StopRequested, true);
  return [this, &simulator, begun = simulator.Begin(index), index](MadeFrame& made) {
    simulator.Scan(*begun, made.frame);
    made.objects =
        surveys_.local().Of(simulator, labels_).Describe(made.frame, simulator.ViewObjects(*begun));
    made.has_image = camera_ && index % frames_per_image_ == 0;
    if (made.has_image) camera_->Render(simulator, *begun, made.image);
  };
}

std::size_t NumFramesAtOnce(const Simulator& simulator, const ScenarioSpec& scenario) {
  // A pixel of the camera's image takes about as much memory as a firing.
  constexpr std::size_t kMostInMemory = 1'000'000;
  std::size_t num_each = simulator.pattern().num_firings();
  if (scenario.camera) {
    num_each += std::size_t{scenario.camera->width_px} * scenario.camera->height_px;
  }
  return std::clamp<std::size_t>(kMostInMemory / num_each, 1, simulator.num_threads() + 1);
}

}  // namespace railcast
