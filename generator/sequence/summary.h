#pragma once

#include <chrono>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "core/program/progress_line.h"
#include "generator/run/make_frames.h"
#include "generator/run/run_plan.h"

namespace railcast {

/// Returns the report after a run: frames, frames per second, points per class, firings per outcome
/// and the directory of the results.
[[nodiscard]] std::string Summary(const SequenceSpec& spec, const SequenceResult& result);

/// A sensor's run for SummaryJson().
struct SummarizedRun {
  std::string sensor;
  const SequenceSpec& spec;
  const SequenceResult& result;
};

/// Returns the same of all sensors as JSON, in one line.
[[nodiscard]] std::string SummaryJson(const std::vector<SummarizedRun>& runs);

/// Returns "frame 12 of 50, 3.2 frames/s, 0:12 left": one line, without its end.
[[nodiscard]] std::string SequenceProgressText(std::uint32_t num_done,
                                               std::uint32_t num_frames,
                                               std::uint32_t num_resumed,
                                               double elapsed_s);

/// Shows SequenceProgressText() of a run in a line of the terminal.
class FrameProgress {
 public:
  /// @param num_done At the first call, those of an earlier run.
  void Show(std::uint32_t num_done, std::uint32_t num_frames);
  /// Ends the line, unless all frames were shown.
  void End();

 private:
  TerminalLine line_;
  bool is_open_ = false;
  std::optional<std::uint32_t> num_resumed_;
  std::chrono::steady_clock::time_point begin_;
};

/// A frame of a run's first sensor as a picture: what the scenario's camera sees, or one in the
/// sensor's place if it has none, with the frame's points over it in the colours of their labels.
/// @return A PNG file.
[[nodiscard]] std::string PictureOfFrame(const RunPlan& plan, std::uint32_t frame, int num_threads);

}  // namespace railcast
