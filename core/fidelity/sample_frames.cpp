#include "core/fidelity/sample_frames.h"

#include <algorithm>
#include <cmath>

namespace railcast {

std::vector<std::uint32_t> SampleFrames(const ScanPattern& pattern,
                                        int num_frames,
                                        double offset_s) {
  std::vector<std::uint32_t> frames;
  for (int i = 0; i < num_frames; ++i) {
    const auto frame = static_cast<std::uint32_t>(std::lround((i + offset_s) * pattern.rate_hz));
    // A slow sensor has less than a frame a second.
    frames.push_back(frames.empty() ? frame : std::max(frame, frames.back() + 1));
  }
  return frames;
}

}  // namespace railcast
