#pragma once

#include <memory>
#include <span>
#include <vector>

#include "core/fidelity/choice_report.h"
#include "generator/run/frame_maker.h"
#include "generator/run/make_frames.h"
#include "generator/run/run_plan.h"
#include "railcast/simulator.h"

namespace railcast {

/// Has the rung `auto` choose for a sensor, and notes the choice in its sequence.
/// @throws RunStopped if the run is stopped meanwhile.
[[nodiscard]] FidelityChoice ChooseFidelity(Simulator& simulator, SensorRun& sensor);

/// Makes the missing frames of the sensors' sequences, with the records of their objects and the
/// images of their cameras (RunSequences()).
/// @param simulators Those of the run, one for each of `sensors`.
/// @param has_commands Whether commands change the run; then its frames are made one by one.
[[nodiscard]] std::vector<SequenceResult> MakeSequences(
    CommandedRun& run,
    const std::vector<std::unique_ptr<Simulator>>& simulators,
    std::span<const SensorRun> sensors,
    bool has_commands,
    const SequenceHooks& hooks);

}  // namespace railcast
