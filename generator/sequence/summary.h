#pragma once

#include <string>
#include <vector>

#include "generator/run/make_frames.h"

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

}  // namespace railcast
