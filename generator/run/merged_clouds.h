#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <span>
#include <vector>

#include "generator/run/run_plan.h"
#include "railcast/lidar.h"
#include "railcast/simulator.h"

namespace railcast {

/// A complete sequence of one of the sensors whose clouds are merged.
struct MergedSensor {
  const SensorRun& run;
  const ScanPattern& pattern;
};

/// @param simulators Those of the runs; both must outlive the result.
[[nodiscard]] std::vector<MergedSensor> MergedSensorsOf(
    const std::vector<std::unique_ptr<Simulator>>& simulators, std::span<const SensorRun> runs);

/// What goes into one merged cloud: a frame of the first sensor, and the frames of the others that
/// begin during its period.
struct MergedFrame {
  struct Part {
    std::size_t sensor{};
    std::uint32_t frame{};
    std::uint32_t later_ns{};  ///< From the first sensor's stamp to this frame's.

    bool operator==(const Part&) const = default;
  };
  std::int64_t stamp_ns{};  ///< Of the first sensor's frame.
  std::vector<Part> parts;  ///< By sensor, then by frame.
};

/// Returns one for each frame that the first sensor's run makes.
[[nodiscard]] std::vector<MergedFrame> MergedFramesOf(std::span<const MergedSensor> sensors);

/// Checks, before anything is made, that the clouds of the sensors can be merged.
/// @throws InputError "--merged: must ...".
void CheckCanMerge(std::span<const MergedSensor> sensors);

/// Writes the merged clouds of complete sequences into the folder `merged` of `directory`, with the
/// vehicle's poses and merged.jsonl, which is written last. Does nothing if that is there.
/// @param on_progress Called with the completed share by one thread at a time.
/// @param is_stopped If it returns true, the work ends.
/// @return False if the work was stopped.
/// @throws InputError if a file cannot be read or written.
[[nodiscard]] bool WriteMergedClouds(const std::filesystem::path& directory,
                                     std::span<const MergedSensor> sensors,
                                     const std::function<void(double)>& on_progress,
                                     const std::function<bool()>& is_stopped);

}  // namespace railcast
