#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "core/io/sensor_turn.h"
#include "core/io/turn_edit.h"
#include "core/io/velodyne/calibration_xml.h"
#include "core/io/velodyne/velodyne_model.h"

namespace railcast {

/// Turns the data packets of a Velodyne sensor, real or simulated, into points.
///
/// Each laser has its own azimuth: that of the block, plus the rotation of the rotor until the
/// laser fires (at the median speed over the packet), plus the laser's own offset. A turn ends
/// where the azimuth falls. Within a packet, the blocks after the gap of an azimuth window are
/// timed by how far the rotor has turned, to within a firing cycle. The turn's stamp counts from
/// the start of the hour in which the first packet was sent; after 10,000 hours that count starts
/// anew.
class VelodyneDecoder {
 public:
  /// For sensors whose angles are in the data sheet.
  /// @pre Not model.has_own_angles.
  explicit VelodyneDecoder(const VelodyneModel& model);
  /// @param calibration One entry for each laser.
  VelodyneDecoder(const VelodyneModel& model, const std::vector<LaserCalibration>& calibration);

  /// Takes the payload of a data packet and appends the turns that it completes.
  /// @returns Why the payload was refused, as "rule (got value)", if it was; nothing of a refused
  ///   payload is used.
  [[nodiscard]] std::optional<std::string> Decode(std::span<const char> payload,
                                                  std::vector<SensorTurn>& turns);

  /// Returns the turn that no packet has completed yet, and starts a new one.
  [[nodiscard]] SensorTurn TakeUnfinished();

  /// Stores the returns of a firing in its packet.
  /// @pre The decoder has taken the packet.
  /// @returns Why the packet cannot state them; it is then unchanged.
  [[nodiscard]] std::optional<std::string> Store(const EditedReturns& returns,
                                                 const FiringPlace& place,
                                                 std::span<char> packet) const;

 private:
  struct Laser {
    double sine{};  ///< Sine of the elevation.
    double cosine{};
    double azimuth_deg{};
    double time_us{};
    LaserCalibration calibration;
    std::uint16_t ring{};
  };
  /// The blocks of one azimuth.
  struct Group {
    const char* blocks{};
    std::uint32_t place{};  ///< Of the blocks in their packet.
    std::uint16_t azimuth{};
    std::int64_t time_ns{};
    bool is_dual{};
  };
  /// A group of which a packet states the time: its first.
  struct StatedGroup {
    std::uint16_t azimuth{};
    std::int64_t time_ns{};
  };

  [[nodiscard]] std::int64_t PacketNs(std::uint32_t us_past_hour);
  /// How many groups the rotor needs to turn from the last one to this azimuth: one, or more where
  /// a sensor that fires in a window of azimuths has not fired.
  /// @param usual_step Between groups, in 0.01 deg.
  [[nodiscard]] std::int64_t GroupsTo(std::uint16_t azimuth,
                                      std::int64_t usual_step,
                                      double group_ns) const;
  void DecodeGroup(const Group& group, double speed_deg_per_us);
  void AddPoint(const char* place, TurnPoint point, double azimuth_deg);

  const VelodyneModel& model_;
  std::vector<Laser> lasers_;
  std::uint32_t num_packets_{};
  std::optional<std::int64_t> last_packet_us_;  ///< Continues counting across hours.
  std::optional<std::uint16_t> last_azimuth_;
  std::optional<StatedGroup> stated_;  ///< The first one of the turn.
  std::int64_t last_group_ns_{};
  SensorTurn turn_;
};

}  // namespace railcast
