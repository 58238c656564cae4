#include "core/io/recording/turn_beams.h"

#include <cmath>
#include <cstddef>
#include <utility>
#include <vector>

#include "core/base/units.h"
#include "core/io/hesai/at128_decoder.h"
#include "core/scan/spinning_pattern.h"

namespace railcast {
namespace {

/// How a row of a spinning sensor is aimed.
struct RowAim {
  double elevation_rad{};
  double azimuth_deg{};  ///< Clockwise, added to the rotor's.
  double turned_us{};    ///< For how long the rotor has turned on since its stated azimuth.
  std::size_t loop{};
};

/// @param azimuth_rad Clockwise.
Vector3 DirectionOf(double azimuth_rad, double elevation_rad) {
  const double level = std::cos(elevation_rad);
  return {level * std::cos(azimuth_rad), -level * std::sin(azimuth_rad), std::sin(elevation_rad)};
}

BeamOfAims BeamsOfRows(std::vector<RowAim> rows) {
  return [rows = std::move(rows)](std::span<const TurnAim> loops, std::uint32_t row_index) {
    const RowAim& row = rows[row_index];
    const TurnAim& aim = loops[row.loop];
    const double azimuth_deg =
        aim.azimuth_deg + row.azimuth_deg + aim.speed_deg_per_us * row.turned_us;
    return RecordedBeam{.direction = DirectionOf(RadFromDeg(azimuth_deg), row.elevation_rad)};
  };
}

}  // namespace

BeamOfAims BeamsOfVelodyne(const VelodyneModel& model) {
  const std::vector<std::uint16_t> rows = RowsByElevation(model.lasers);
  std::vector<RowAim> aims(rows.size());
  for (std::size_t i = 0; i < rows.size(); ++i) {
    const ChannelSpec& laser = model.lasers[i];
    aims[rows[i]] = {RadFromDeg(laser.elevation_deg), laser.azimuth_deg, laser.time_us, 0};
  }
  return BeamsOfRows(std::move(aims));
}

BeamOfAims BeamsOfHesai(const HesaiModel& model) {
  const std::vector<std::uint16_t> rows = RowsByElevation(model.channels);
  std::vector<RowAim> aims(rows.size());
  std::size_t next = 0;
  for (std::size_t loop = 0; loop < model.loops.size(); ++loop) {
    const double loop_us = 1e-3 * static_cast<double>(model.loop_ns) * static_cast<double>(loop);
    for (std::size_t i = 0; i < model.loops[loop].size(); ++i, ++next) {
      const ChannelSpec& channel = model.channels[next];
      const double turned_us = model.turned_us ? *model.turned_us + channel.time_us - loop_us : 0.0;
      aims[rows[next]] = {RadFromDeg(channel.elevation_deg), channel.azimuth_deg, turned_us, loop};
    }
  }
  return BeamsOfRows(std::move(aims));
}

BeamOfAims BeamsOfOuster(const OusterMetadata& metadata) {
  std::vector<ChannelSpec> channels;
  for (const OusterBeam& beam : metadata.beams) {
    channels.push_back({beam.altitude_deg, beam.azimuth_deg, 0.0});
  }
  const std::vector<std::uint16_t> rows = RowsByElevation(channels);
  std::vector<RowAim> aims(rows.size());
  for (std::size_t i = 0; i < rows.size(); ++i) {
    aims[rows[i]] = {RadFromDeg(channels[i].elevation_deg), channels[i].azimuth_deg, 0.0, 0};
  }
  return [aims = std::move(aims), origin_m = metadata.beam_origin_m,
          sensor_from_lidar = metadata.sensor_from_lidar](std::span<const TurnAim> loops,
                                                          std::uint32_t row) {
    const double rotor_rad = RadFromDeg(loops[0].azimuth_deg);
    const double azimuth_rad = rotor_rad + RadFromDeg(aims[row].azimuth_deg);
    const Vector3 origin_in_lidar_m(origin_m[0] * std::cos(rotor_rad),
                                    -origin_m[0] * std::sin(rotor_rad), origin_m[1]);
    return RecordedBeam{
        sensor_from_lidar.linear() * DirectionOf(azimuth_rad, aims[row].elevation_rad),
        sensor_from_lidar * origin_in_lidar_m};
  };
}

BeamOfAims BeamsOfAt128(const std::shared_ptr<const At128Correction>& correction) {
  const std::vector<std::uint16_t> rows = RowsByElevation(At128Channels(*correction));
  std::vector<std::size_t> laser_of_row(rows.size());
  for (std::size_t laser = 0; laser < rows.size(); ++laser) laser_of_row[rows[laser]] = laser;
  return [=](std::span<const TurnAim> loops, std::uint32_t row) {
    const double block_deg = loops[0].azimuth_deg;
    const auto [azimuth_deg, elevation_deg] =
        correction->At(block_deg, correction->FieldAt(block_deg), laser_of_row[row]);
    return RecordedBeam{.direction =
                            DirectionOf(RadFromDeg(azimuth_deg), RadFromDeg(elevation_deg))};
  };
}

std::function<RecordedBeam(std::uint32_t, std::uint32_t)> BeamsOfTurn(const SensorTurn& turn,
                                                                      const BeamOfAims& beam_of) {
  if (turn.num_columns() == 0) return {};
  const std::size_t num_loops = turn.aims.size() / turn.num_columns();
  return [aims = std::make_shared<const std::vector<TurnAim>>(turn.aims), num_loops, beam_of](
             std::uint32_t row, std::uint32_t column) {
    return beam_of(std::span(*aims).subspan(column * num_loops, num_loops), row);
  };
}

}  // namespace railcast
