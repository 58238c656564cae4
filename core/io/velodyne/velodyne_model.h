#pragma once

#include <cstddef>
#include <cstdint>
#include <string_view>
#include <vector>

#include "core/io/velodyne/velodyne_packet.h"
#include "railcast/lidar.h"

namespace railcast {

/// The properties that distinguish the packets of one Velodyne sensor from those of another.
struct VelodyneModel {
  std::string_view name;
  std::uint8_t id{};            ///< The last byte of a packet.
  bool has_mode_and_id = true;  ///< False for HDL-64E, whose packets end in status bytes instead.
  /// Whether each unit has a calibration, as with HDL-64E: elevations and azimuths below are then
  /// 0.
  bool has_own_angles{};
  double distance_unit_m{};  ///< 65535 units are the greatest range that a packet can hold.
  double cycle_us{};         ///< Time from one firing cycle to the next.
  /// In the order of the packets. Azimuths count clockwise, times from the start of the cycle.
  std::vector<ChannelSpec> lasers{};

  [[nodiscard]] std::size_t blocks_per_cycle() const {
    return lasers.size() > kLasersPerBlock ? lasers.size() / kLasersPerBlock : 1;
  }
  [[nodiscard]] std::size_t cycles_per_block() const {
    return lasers.size() < kLasersPerBlock ? kLasersPerBlock / lasers.size() : 1;
  }
};

/// A packet format as named on command lines: a sensor and its return mode.
struct VelodyneFormat {
  std::string_view name;
  const VelodyneModel* model{};
  bool is_dual{};
};

/// Returns the format of this name.
/// @param name One of vlp16, vlp16-dual, hdl32e, vlp32c, hdl64e.
/// @throws InputError if it is none of them.
[[nodiscard]] VelodyneFormat FindVelodyneFormat(std::string_view name);

/// VLS-128, whose packets can be read but are no format to send: a cycle takes four blocks, and
/// dual packets, which are padded, are not known to the decoder.
[[nodiscard]] const VelodyneModel& Vls128Model();

/// The models whose packets do not depend on a calibration.
[[nodiscard]] std::vector<const VelodyneModel*> ModelsWithoutCalibration();

}  // namespace railcast
