#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "generator/run/frame_maker.h"
#include "generator/run/run_plan.h"
#include "railcast/lidar.h"

namespace railcast {

/// A complete sequence of one of the sensors whose clouds are merged.
struct MergedSensor {
  const SensorPlan& plan;
  const ScanPattern& pattern;
};

/// What goes into one merged cloud: a frame of the first sensor, and the frames of the others that
/// begin during its period.
struct MergedFrame {
  struct Part {
    std::size_t sensor{};
    std::uint32_t frame{};
    std::uint32_t later_ns{};  ///< From the first sensor's stamp to this frame's.

    bool operator==(const Part&) const = default;
  };
  std::int64_t stamp_ns{};  ///< Stamp of the first sensor's frame.
  std::vector<Part> parts;  ///< By sensor, then by frame.
};

/// Returns that of the i-th frame that is made of the first sensor.
[[nodiscard]] MergedFrame MergedFrameOf(std::span<const MergedSensor> sensors, std::uint32_t i);

/// Checks, before anything is made, that the clouds of the sensors can be merged.
/// @throws InputError "--merged: must ...".
void CheckCanMerge(const FrameMaker& maker, const RunPlan& plan);

/// What is wrong with the sensors.json of a run that was complete, by its own hash; nothing if that
/// is right, or if there is none.
[[nodiscard]] std::optional<std::string> FaultOfList(const RunPlan& plan);

/// Makes of complete sequences what is about all of them: of several sensors sensors.json, which
/// says where each is, and before it, if they are to be merged, the folder `merged` with the
/// clouds, the vehicle's poses and merged.jsonl, which is written last. What is there is not made
/// again.
/// @param on_progress Called with the completed share of the clouds by one thread at a time.
/// @param is_stopped If it returns true, the work ends.
/// @return False if the work was stopped.
/// @throws InputError if a file cannot be read or written.
[[nodiscard]] bool FinishRun(const FrameMaker& maker,
                             const RunPlan& plan,
                             const std::function<void(double)>& on_progress,
                             const std::function<bool()>& is_stopped);

}  // namespace railcast
