#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "core/io/sensor_turn.h"
#include "core/scan/scan_spec.h"

namespace railcast {

/// The 64 channels of Hesai's Pandar64, in its order, as the factory has them: those of
/// scenarios/sensors/pandar64.json. Azimuths count clockwise, times from the start of the cycle.
[[nodiscard]] const std::vector<ChannelSpec>& Pandar64Channels();

/// Turns the data packets of a Pandar64 into points.
///
/// A laser's azimuth is its block's plus its own offset: the sensor has accounted for its firing
/// time. A packet's time is that of its end: the last block ends 42.58 us before it, others 55.56
/// us each before that (HesaiLidar_SDK, PandarGeneral; tier4/nebula, pandar_64.hpp). A turn ends
/// where the azimuth falls; its stamp counts from 1970-01-01 by the sensor's own clock, from the
/// start of the day if that has no date.
class Pandar64Decoder {
 public:
  Pandar64Decoder();

  /// Takes the payload of a data packet and appends the turns that it completes.
  /// @returns Why the payload was refused, "rule (got value)", if it was: nothing of it is used.
  [[nodiscard]] std::optional<std::string> Decode(std::span<const char> payload,
                                                  std::vector<SensorTurn>& turns);

  /// The turn that no packet has completed; starts a new one.
  [[nodiscard]] SensorTurn TakeUnfinished();

 private:
  struct Laser {
    double sine{};  ///< Of the elevation.
    double cosine{};
    double azimuth_deg{};
    std::int64_t time_ns{};  ///< Since the start of the cycle.
    std::uint16_t ring{};
  };
  /// The blocks of one firing cycle.
  struct Group {
    const char* blocks{};
    std::uint16_t azimuth{};  ///< 0.01 deg
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
