#pragma once

#include <cstdint>
#include <vector>

#include "core/scan/scan_pattern.h"

namespace railcast {

/// Frames that stand for a scenario: `offset_s`, `offset_s` + 1, ... seconds after its begin. They
/// depend on the scan pattern's rate alone, never on the part of the run that is being made.
[[nodiscard]] std::vector<std::uint32_t> SampleFrames(const ScanPattern& pattern,
                                                      int num_frames,
                                                      double offset_s = 0.0);

}  // namespace railcast
