#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "core/io/sensor_turn.h"
#include "core/io/velodyne/calibration_xml.h"
#include "core/io/velodyne/velodyne_model.h"

namespace railcast {

/// Turns the data packets of a Velodyne sensor, real or ours, into points.
///
/// Each laser has its own azimuth: the block's, plus what the rotor turns until its firing (its
/// speed is the median over the packet), plus its own offset. A turn ends where the azimuth falls;
/// its stamp counts from the start of the hour in which the first packet was sent, anew after
/// 10,000 hours.
class VelodyneDecoder {
 public:
  /// Of sensors whose angles are in the data sheet. @pre Not model.has_own_angles.
  explicit VelodyneDecoder(const VelodyneModel& model);
  /// @param calibration One for each laser.
  VelodyneDecoder(const VelodyneModel& model, const std::vector<LaserCalibration>& calibration);

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
    double time_us{};
    LaserCalibration calibration;
    std::uint16_t ring{};
  };
  /// The blocks of one azimuth.
  struct Group {
    const char* blocks{};
    std::uint16_t azimuth{};
    std::int64_t time_ns{};
    bool is_dual{};
  };

  [[nodiscard]] std::int64_t PacketNs(std::uint32_t us_past_hour);
  void DecodeGroup(const Group& group, double speed_deg_per_us);
  void AddPoint(const char* place, TurnPoint point, double azimuth_deg);

  const VelodyneModel& model_;
  std::vector<Laser> lasers_;
  std::optional<std::int64_t> last_packet_us_;  ///< Counted on over the hours.
  std::optional<std::uint16_t> last_azimuth_;
  SensorTurn turn_;
};

}  // namespace railcast
