#pragma once

#include <cstddef>
#include <cstdint>
#include <string_view>
#include <vector>

#include "core/io/velodyne/velodyne_packet.h"
#include "core/scan/scan_spec.h"

namespace railcast {

/// All that tells the packets of one Velodyne sensor from another's.
struct VelodyneModel {
  std::string_view name;
  std::uint8_t id{};       ///< The last byte of a packet.
  bool has_mode_and_id{};  ///< HDL-64E's packets end in status bytes instead.
  bool has_own_angles{};   ///< Each HDL-64E has a calibration: elevations and azimuths below are 0.
  double distance_unit_m{};  ///< 65535 of them is the farthest that a packet can say.
  double cycle_us{};         ///< From one firing cycle to the next.
  /// In the order of the packets. Azimuths count clockwise, times from the start of the cycle.
  std::vector<ChannelSpec> lasers;

  [[nodiscard]] std::size_t blocks_per_cycle() const {
    return lasers.size() > kLasersPerBlock ? lasers.size() / kLasersPerBlock : 1;
  }
  [[nodiscard]] std::size_t cycles_per_block() const {
    return lasers.size() < kLasersPerBlock ? kLasersPerBlock / lasers.size() : 1;
  }
};

/// What a packet stream is called on command lines: a sensor and its return mode.
struct VelodyneFormat {
  std::string_view name;
  const VelodyneModel* model{};
  bool is_dual{};
};

/// @param name One of vlp16, vlp16-dual, hdl32e, vlp32c, hdl64e.
/// @throws InputError if it is none of them.
[[nodiscard]] VelodyneFormat FindVelodyneFormat(std::string_view name);

}  // namespace railcast
