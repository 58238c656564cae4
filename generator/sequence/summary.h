#pragma once

#include <string>

#include "generator/sequence/run_sequence.h"

namespace railcast {

/// Returns the report after a run: frames, frames per second, points per class, firings per outcome
/// and the directory of the results.
[[nodiscard]] std::string Summary(const SequenceSpec& spec, const SequenceResult& result);

/// Returns "frame 12 of 50, 3.2 frames/s, 0:12 left": one line, without its end.
[[nodiscard]] std::string SequenceProgressText(std::uint32_t num_done,
                                               std::uint32_t num_frames,
                                               std::uint32_t num_resumed,
                                               double elapsed_s);

}  // namespace railcast
