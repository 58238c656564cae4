#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "core/io/velodyne/calibration_xml.h"
#include "core/io/velodyne/velodyne_model.h"

namespace railcast {

struct VelodynePoint {
  float x{}, y{}, z{};  ///< m, our sensor axes: x forward, y left, z up.
  float range_m{};
  float azimuth_rad{};     ///< Clockwise from forward, 0 to 2 pi.
  std::int64_t time_ns{};  ///< Since the turn's stamp.
  std::uint16_t ring{};    ///< Row by rising elevation, 0 the lowest.
  std::uint8_t laser{};    ///< The vendor's number, from 0.
  std::uint8_t intensity{};
  /// 0, or in dual mode 0 for the last return and 1 for the other, which is left out where it
  /// repeats the last.
  std::uint8_t return_index{};
};

/// What one turn of the rotor saw, in order of time.
struct VelodyneTurn {
  /// Of its first firing, since the start of the hour in which the first packet was sent; counted
  /// anew after 10,000 hours.
  std::int64_t stamp_ns{};
  std::vector<VelodynePoint> points;
};

/// Turns the data packets of a Velodyne sensor, real or ours, into points.
///
/// Each laser has its own azimuth: the block's, plus what the rotor turns until its firing (its
/// speed is the median over the packet), plus its own offset. A turn ends where the azimuth falls.
class VelodyneDecoder {
 public:
  /// Of sensors whose angles are in the data sheet. @pre Not model.has_own_angles.
  explicit VelodyneDecoder(const VelodyneModel& model);
  /// @param calibration One for each laser.
  VelodyneDecoder(const VelodyneModel& model, const std::vector<LaserCalibration>& calibration);

  /// Takes the payload of a data packet and appends the turns that it completes.
  /// @returns Why the payload was refused, "rule (got value)", if it was: nothing of it is used.
  [[nodiscard]] std::optional<std::string> Decode(std::span<const char> payload,
                                                  std::vector<VelodyneTurn>& turns);

  /// The turn that no packet has completed; starts a new one.
  [[nodiscard]] VelodyneTurn TakeUnfinished();

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
  void AddPoint(const char* place, VelodynePoint point, double azimuth_deg);

  const VelodyneModel& model_;
  std::vector<Laser> lasers_;
  std::optional<std::int64_t> last_packet_us_;  ///< Counted on over the hours.
  std::optional<std::uint16_t> last_azimuth_;
  VelodyneTurn turn_;
};

}  // namespace railcast
