#pragma once

#include <algorithm>
#include <cstdint>
#include <ranges>

#include "railcast/lidar.h"
#include "railcast/rail_world.h"
#include "railcast/scenario.h"
#include "railcast/scene.h"

namespace railcast {

/// Checks that nothing leaves its track.
/// @throws InputError if the vehicle or an object leaves its track before the end of frame
///   `last_frame`, with a line for each: "file: /vehicle/motion: leaves track "main", from 0 to
///   1000 m, at frame 54 (5.4 s)".
/// @param world The world of the scenario, or the one that commands made of it; lines about what
///   commands changed read "command: the vehicle leaves track ...".
void CheckStaysOnTracks(const ScenarioSpec& scenario,
                        const RailWorld& world,
                        const ScanPattern& pattern,
                        std::uint32_t first_frame,
                        std::uint32_t last_frame);

/// Returns the last frame up to `last_frame` before the vehicle or an object leaves its track; 0 if
/// one is off its track in frame 0.
[[nodiscard]] std::uint32_t LastFrameOnTracks(const ScenarioSpec& scenario,
                                              const RailWorld& world,
                                              const ScanPattern& pattern,
                                              std::uint32_t last_frame);

/// Returns the first frame of [begin, end) for which `is_before` is false, or `end`; it is false
/// for all later ones, too.
template <typename Predicate>
[[nodiscard]] std::uint32_t FirstFrameBeyond(std::uint32_t begin,
                                             std::uint32_t end,
                                             const Predicate& is_before) {
  return *std::ranges::partition_point(std::views::iota(begin, end), is_before);
}

/// Returns the first frame of [begin, end) that is stamped at a time or later, or `end`.
[[nodiscard]] std::uint32_t FirstStampedAt(const ScanPattern& pattern,
                                           std::int64_t time_ns,
                                           std::uint32_t begin,
                                           std::uint32_t end);

/// Returns the last frame that is stamped before a time, or the last one whose stamp fits into 64
/// bits if that comes earlier; 0 if there is none.
[[nodiscard]] std::uint32_t LastFrameBefore(const ScanPattern& pattern, std::int64_t time_ns);

/// Checks that the sensor's own vehicle is not inside an object at the stamp of any frame, unless
/// the scenario allows it (`vehicle.may_overlap`). Touching is allowed. A vehicle without ego boxes
/// is nowhere inside.
/// @throws InputError with a line for each object, about the first such frame:
///   "file: /vehicle: must not be inside an object unless may_overlap is true
///   (got 0.11 m inside "wagon" at frame 54 (5.4 s))".
/// @param world The world of the scenario.
void CheckVehicleIsClear(const ScenarioSpec& scenario,
                         const World& world,
                         const ScanPattern& pattern,
                         std::uint32_t first_frame,
                         std::uint32_t last_frame);

}  // namespace railcast
