#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "core/io/sensor_turn.h"
#include "railcast/lidar.h"

namespace railcast {

/// The 64 channels of Hesai's Pandar64 in the vendor's order, with the factory's angles and times;
/// scenarios/sensors/pandar64.json has the same ones. Azimuths count clockwise, times from the
/// start of the firing cycle.
[[nodiscard]] const std::vector<ChannelSpec>& Pandar64Channels();

/// Turns the data packets of a Pandar64 into points.
///
/// A laser's azimuth is that of its block plus the laser's own offset; the sensor has already
/// accounted for the time of the firing. A packet is stamped with the time at which it ends: the
/// last block ends 42.58 us before that, and each earlier block 55.56 us before the next
/// (HesaiLidar_SDK, PandarGeneral; tier4/nebula, pandar_64.hpp). A turn ends where the azimuth
/// falls. The stamp of a turn counts from 1970-01-01 by the sensor's own clock, or from the start
/// of the day if that clock has no date.
class Pandar64Decoder {
 public:
  Pandar64Decoder();

  /// Takes the payload of a data packet and appends the turns that it completes.
  /// @returns Why the payload was refused, as "rule (got value)", if it was; nothing of a refused
  ///   payload is used.
  [[nodiscard]] std::optional<std::string> Decode(std::span<const char> payload,
                                                  std::vector<SensorTurn>& turns);

  /// Returns the turn that no packet has completed yet, and starts a new one.
  [[nodiscard]] SensorTurn TakeUnfinished();

 private:
  struct Laser {
    double sine{};  ///< Sine of the elevation.
    double cosine{};
    double azimuth_deg{};
    std::int64_t time_ns{};  ///< Time of the firing since the start of the cycle.
    std::uint16_t ring{};
  };
  /// The blocks of one firing cycle.
  struct Group {
    const char* blocks{};
    std::uint16_t azimuth{};  ///< Azimuth in 0.01 deg.
    double unit_m{};
    bool is_dual{};
  };

  void DecodeGroup(const Group& group, std::int64_t since_stamp_ns);
  void AddPoint(const char* place, const Group& group, TurnPoint point);

  std::vector<Laser> lasers_;
  std::optional<std::uint16_t> last_azimuth_;
  SensorTurn turn_;
};

}  // namespace railcast
