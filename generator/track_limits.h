#pragma once

#include <cstdint>

#include "core/rail/rail_world.h"
#include "core/scan/scan_pattern.h"
#include "core/scenario/scenario_spec.h"
#include "generator/commanded_run.h"

namespace railcast {

/// @throws InputError if the vehicle or an object leaves its track before the end of frame
///   `last_frame`, a line for each: "file: /vehicle/motion: leaves track "main", from 0 to 1000 m,
///   at frame 54 (5.4 s)".
/// @param world Of the scenario, or what commands made of it: the line of what they changed reads
///   "command: the vehicle leaves track ...".
void CheckStaysOnTracks(const ScenarioSpec& scenario,
                        const RailWorld& world,
                        const ScanPattern& pattern,
                        std::uint32_t first_frame,
                        std::uint32_t last_frame);

/// The same of a run's worlds, each for the frames that it holds for.
void CheckStaysOnTracks(const CommandedRun& run,
                        const ScanPattern& pattern,
                        std::uint32_t first_frame,
                        std::uint32_t last_frame);

/// The last frame that is stamped before a time, or at which times end; 0 if none is.
[[nodiscard]] std::uint32_t LastFrameBefore(const ScanPattern& pattern, std::int64_t time_ns);

}  // namespace railcast
