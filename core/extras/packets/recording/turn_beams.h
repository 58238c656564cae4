#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <span>

#include "core/extras/packets/spinning/spinning_model.h"
#include "core/io/sensor_turn.h"
#include "core/scenario/ouster_metadata.h"
#include "railcast/io/recording.h"

namespace railcast {

/// Gives the beam of a row, 0 the lowest, from the aims of a firing cycle's loops. What has a point
/// has it on this beam: the decoders compute the same.
using BeamOfAims = std::function<RecordedBeam(std::span<const TurnAim> loops, std::uint32_t row)>;

[[nodiscard]] BeamOfAims BeamsOfSpinning(const SpinningModel& model);
[[nodiscard]] BeamOfAims BeamsOfOuster(const OusterMetadata& metadata);

/// Gives the beams of a turn's frame: RecordedFrame::beam_of.
[[nodiscard]] std::function<RecordedBeam(std::uint32_t row, std::uint32_t column)> BeamsOfTurn(
    const SensorTurn& turn, const BeamOfAims& beam_of);

}  // namespace railcast
