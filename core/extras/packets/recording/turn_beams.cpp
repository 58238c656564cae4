#include "core/extras/packets/recording/capture_sensor.h"

#include <cmath>
#include <cstddef>
#include <utility>
#include <vector>

#include "core/base/units.h"
#include "core/extras/packets/ouster/ouster_decoder.h"
#include "core/scan/spinning_pattern.h"

namespace railcast {
namespace {

/// How a row of a spinning sensor is aimed.
struct RowAim {
  double elevation_deg{};
  double azimuth_deg{};  ///< Clockwise, added to the rotor's.
  PacketFiring firing;
};

/// @param azimuth_rad Clockwise.
Vector3 DirectionOf(double azimuth_rad, double elevation_rad) {
  const double level = std::cos(elevation_rad);
  return {level * std::cos(azimuth_rad), -level * std::sin(azimuth_rad), std::sin(elevation_rad)};
}

}  // namespace

BeamOfAims BeamsOfSpinning(const SpinningModel& model) {
  std::vector<RowAim> rows(model.channels.size());
  std::size_t next = 0;
  for (const PacketFiring& firing : FiringsOf(model, model.channels)) {
    const ChannelSpec& channel = model.channels[next++];
    rows[firing.row] = {channel.elevation_deg, channel.azimuth_deg, firing};
  }
  return [rows = std::move(rows), correction = model.correction](std::span<const TurnAim> loops,
                                                                 std::uint32_t row_index) {
    auto [elevation_deg, azimuth_deg, firing] = rows[row_index];
    const TurnAim& aim = loops[firing.loop];
    azimuth_deg = aim.azimuth_deg + azimuth_deg + aim.speed_deg_per_us * firing.turned_us;
    if (correction) {
      const std::size_t field = correction->FieldAt(aim.azimuth_deg);
      const auto direction = correction->At(aim.azimuth_deg, field, firing.laser);
      azimuth_deg = direction.azimuth_deg;
      elevation_deg = direction.elevation_deg;
    }
    return RecordedBeam{.direction =
                            DirectionOf(RadFromDeg(azimuth_deg), RadFromDeg(elevation_deg))};
  };
}

BeamOfAims BeamsOfOuster(const OusterMetadata& metadata) {
  const std::vector<ChannelSpec> channels = ChannelsOf(metadata);
  const std::vector<std::uint16_t> rows = RowsByElevation(channels);
  std::vector<ChannelSpec> aims(rows.size());
  for (std::size_t i = 0; i < rows.size(); ++i) aims[rows[i]] = channels[i];
  return [aims = std::move(aims), origin_m = metadata.beam_origin_m,
          sensor_from_lidar = metadata.sensor_from_lidar](std::span<const TurnAim> loops,
                                                          std::uint32_t row) {
    const double rotor_rad = RadFromDeg(loops[0].azimuth_deg);
    const double azimuth_rad = rotor_rad + RadFromDeg(aims[row].azimuth_deg);
    const Vector3 origin_in_lidar_m(origin_m[0] * std::cos(rotor_rad),
                                    -origin_m[0] * std::sin(rotor_rad), origin_m[1]);
    return RecordedBeam{
        sensor_from_lidar.linear() * DirectionOf(azimuth_rad, RadFromDeg(aims[row].elevation_deg)),
        sensor_from_lidar * origin_in_lidar_m};
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
