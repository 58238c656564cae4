#pragma once

#include <tbb/enumerable_thread_specific.h>

#include <cstddef>
#include <cstdint>
#include <optional>

#include "generator/record/object_survey.h"
#include "generator/run/frame_maker.h"
#include "generator/run/make_frames.h"
#include "railcast/camera.h"
#include "railcast/frame.h"
#include "railcast/simulator.h"

namespace railcast {

/// Makes the frames of a run together with the records of their objects and the camera's images.
class SurveyedRun {
 public:
  /// @param run Must outlive this object, as must `labels`.
  /// @param sensor Which of the run's sensors.
  /// @param scenario That of the run, reduced to the sensor (PickSensor()); its camera's images are
  ///   made, too.
  SurveyedRun(CommandedRun& run,
              std::size_t sensor,
              const ScenarioSpec& scenario,
              const LabelTable& labels);

  /// As BeginFrame.
  /// @throws InputError if the vehicle or an object leaves its track in that frame.
  [[nodiscard]] FrameJob Begin(std::uint32_t index);

 private:
  CommandedRun& run_;
  std::size_t sensor_;
  const LabelTable& labels_;
  std::optional<Camera> camera_;
  std::uint32_t frames_per_image_ = 1;
  /// Each remembers what it measured, so that each thread has its own.
  tbb::enumerable_thread_specific<CurrentSurvey> surveys_;
};

/// How many frames are made at once where none depends on another: one for each thread, and one
/// that waits for its turn to be written. Frames of a million firings, or with
/// images of millions of pixels, keep all threads busy by themselves and take much memory: they are
/// made one after another.
[[nodiscard]] std::size_t NumFramesAtOnce(const Simulator& simulator, const ScenarioSpec& scenario);

}  // namespace railcast
