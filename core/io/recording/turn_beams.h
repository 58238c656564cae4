#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <span>

#include "core/io/hesai/at128_correction.h"
#include "core/io/hesai/hesai_model.h"
#include "core/io/sensor_turn.h"
#include "core/io/velodyne/velodyne_model.h"
#include "core/scenario/ouster_metadata.h"
#include "railcast/io/recording.h"

namespace railcast {

/// Gives the beam of a row, 0 the lowest, from the aims of a firing cycle's loops. What has a point
/// has it on this beam: the decoders compute the same.
using BeamOfAims = std::function<RecordedBeam(std::span<const TurnAim> loops, std::uint32_t row)>;

[[nodiscard]] BeamOfAims BeamsOfVelodyne(const VelodyneModel& model);
[[nodiscard]] BeamOfAims BeamsOfHesai(const HesaiModel& model);
[[nodiscard]] BeamOfAims BeamsOfOuster(const OusterMetadata& metadata);
[[nodiscard]] BeamOfAims BeamsOfAt128(const std::shared_ptr<const At128Correction>& correction);

/// Gives the beams of a turn's frame: RecordedFrame::beam_of.
[[nodiscard]] std::function<RecordedBeam(std::uint32_t row, std::uint32_t column)> BeamsOfTurn(
    const SensorTurn& turn, const BeamOfAims& beam_of);

}  // namespace railcast
