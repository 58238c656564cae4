#include "core/scan/at128_sweep.h"

#include <cmath>
#include <memory>

#include "core/base/error.h"
#include "core/base/units.h"
#include "core/scan/firing.h"
#include "core/scan/spinning_pattern.h"

namespace railcast {
namespace {

constexpr double kSweepTurn_deg = 60.0;

double StepOfBlocks_deg(double rate_hz) {
  return At128Correction::kFieldTurn_deg * rate_hz * kAt128Block_us * 1e-6;
}

FiringGrid SweepOf(const At128Correction& correction, double rate_hz, std::uint32_t frame) {
  const std::vector<ChannelSpec> channels = At128Channels(correction);
  const std::vector<std::uint16_t> rows = RowsByElevation(channels);
  FiringGrid grid{.rows = kAt128Lasers, .columns = At128Columns(rate_hz), .firings = {}};
  grid.firings.reserve(std::size_t{grid.rows} * grid.columns);
  for (std::uint32_t column = 0; column < grid.columns; ++column) {
    const double block_deg =
        At128Azimuth(correction, rate_hz, frame, column) / At128Correction::kStepsPerDeg;
    const std::size_t field = correction.FieldAt(block_deg);
    const double block_us = column * kAt128Block_us;
    for (std::size_t laser = 0; laser < kAt128Lasers; ++laser) {
      const auto [azimuth_deg, elevation_deg] = correction.At(block_deg, field, laser);
      grid.firings.push_back({.azimuth_rad = -RadFromDeg(std::remainder(azimuth_deg, 360.0)),
                              .elevation_rad = RadFromDeg(elevation_deg),
                              .time_ns = std::llround(1e3 * (block_us + channels[laser].time_us)),
                              .row = rows[laser],
                              .column = column});
    }
  }
  return grid;
}

}  // namespace

std::vector<ChannelSpec> At128Channels(const At128Correction& correction) {
  std::vector<ChannelSpec> channels;
  for (std::size_t laser = 0; laser < kAt128Lasers; ++laser) {
    channels.push_back({.elevation_deg = correction.elevation_deg(laser),
                        .time_us = 1e-3 * kAt128Firing_ns[laser]});
  }
  return channels;
}

std::uint32_t At128Columns(double rate_hz) {
  return 2 * static_cast<std::uint32_t>(kSweepTurn_deg / 2.0 / StepOfBlocks_deg(rate_hz));
}

std::uint32_t At128Azimuth(const At128Correction& correction,
                           double rate_hz,
                           std::uint32_t frame,
                           std::uint32_t column) {
  // A mirror looks forward 45 deg of the rotor behind the start of its field.
  constexpr double kForward_deg = 45.0;
  const double from_middle = column - (At128Columns(rate_hz) - 1) / 2.0;
  const double azimuth_deg = correction.mean_start_deg() + kForward_deg +
                             At128Correction::kFieldTurn_deg * (frame % At128Correction::kFields) +
                             StepOfBlocks_deg(rate_hz) * from_middle;
  return static_cast<std::uint32_t>(std::lround(azimuth_deg * At128Correction::kStepsPerDeg) %
                                    std::lround(360.0 * At128Correction::kStepsPerDeg));
}

FramesOfFirings At128Firings(const FiringTableSpec& spec, double rate_hz, ErrorList& errors) {
  if (spec.frames != At128Correction::kFields) {
    errors.Add(FaultOf("/pattern/frames", "must be 3, the mirrors of an AT128", spec.frames));
  }
  if (!(rate_hz >= 1.0 && rate_hz <= 100.0)) {
    errors.Add(FaultOf("/rate_hz", "must be >= 1 and <= 100 with an AT128's file", rate_hz));
  }
  const auto correction = Attempt("/pattern/file: ", errors, [&] {
    return std::make_shared<const At128Correction>(ReadAt128Correction(spec.file));
  });
  if (!errors.empty()) return {};
  const auto of_frame = [rate_hz, file = *correction](std::uint32_t frame_index, std::int64_t) {
    return SweepOf(*file, rate_hz, frame_index);
  };
  return {of_frame(0, 0), std::make_shared<const MovingFigure>(MovingFigure{of_frame})};
}

}  // namespace railcast
