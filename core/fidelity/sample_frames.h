#pragma once

#include <cstdint>
#include <vector>

#include "railcast/scenario.h"
#include "railcast/simulator.h"

namespace railcast {

/// The last frame of a scenario's run: the run ends before the vehicle or an object leaves its
/// track, or when nothing moves any more. It depends on the scenario alone, not on the part of the
/// run that is being simulated.
/// @param simulator The simulator of the scenario.
/// @param num_frames At least 1. Where nothing moves, the run still lasts for so many frames if the
///   tracks permit: they differ in their random draws.
[[nodiscard]] std::uint32_t LastFrameOfRun(const ScenarioSpec& scenario,
                                           const Simulator& simulator,
                                           int num_frames);

/// Frames in the middles of `num_frames` equal parts of a run; all of its frames if it is shorter.
[[nodiscard]] std::vector<std::uint32_t> SpreadFrames(std::uint32_t last_frame, int num_frames);

/// The frames in which objects of the world matter most: where they are nearest to the sensor, and
/// where they come within half of its range. A frame in which another object is about as far away
/// as in a frame of its own (a factor of 1.5) serves both. Of the frames needed for all objects,
/// those that serve most come first, and at most `num_most` are returned, in ascending order. Of a
/// crowd of objects, 64 are considered.
[[nodiscard]] std::vector<std::uint32_t> FramesAtObjects(const ScenarioSpec& scenario,
                                                         const Simulator& simulator,
                                                         std::uint32_t last_frame,
                                                         int num_most);

/// Frames on the way to the object that the sensor approaches most, in ascending order: from where
/// it comes within range to where it is nearest, at distances of equal ratios. None if no object
/// comes nearer by a factor of 1.5 within range.
[[nodiscard]] std::vector<std::uint32_t> ApproachFrames(const ScenarioSpec& scenario,
                                                        const Simulator& simulator,
                                                        int num_frames);

/// Frames that represent a scenario, in ascending order: up to half of them are FramesAtObjects(),
/// and the others are spread over the run. Fewer than `num_frames` if the run has fewer.
[[nodiscard]] std::vector<std::uint32_t> SampleFrames(const ScenarioSpec& scenario,
                                                      const Simulator& simulator,
                                                      int num_frames);

}  // namespace railcast
