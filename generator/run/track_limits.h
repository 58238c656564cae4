#pragma once

#include <cstdint>

#include "core/scenario/track_limits.h"
#include "generator/run/frame_maker.h"
#include "railcast/lidar.h"

namespace railcast {

/// As CheckStaysOnTracks() of a scenario's world, for the worlds of a run, each for the frames for
/// which it holds.
void CheckStaysOnTracks(const CommandedRun& run,
                        const ScanPattern& pattern,
                        std::uint32_t first_frame,
                        std::uint32_t last_frame);

}  // namespace railcast
