#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string_view>
#include <vector>

#include "railcast/lidar.h"

namespace railcast {

/// Where the data packets of a Hesai sensor have what, in bytes from their start. All of them are
/// little-endian and begin like this:
///   EE FF, the rest of the header,
///   blocks { u16 azimuth in 0.01 deg, lasers x { u16 distance, u8 reflectivity in percent, ... } }
struct HesaiLayout {
  std::size_t packet_size{};
  std::optional<std::array<std::uint8_t, 2>> version;  ///< Bytes 2 and 3, where they hold one.
  std::size_t lasers_place{};                          ///< u8, the number of lasers.
  std::size_t blocks_place{};                          ///< u8, the number of blocks.
  std::size_t unit_place{};                            ///< u8, the unit of distances in mm.
  std::size_t header_size{};
  std::size_t lasers{};
  std::size_t blocks{};
  std::size_t return_size{};                ///< Bytes of a laser's return.
  std::optional<std::size_t> loop_place{};  ///< u8, odd if the packet begins with loop 1.
  std::size_t mode_place{};                 ///< u8, the return mode.
  std::size_t speed_place{};                ///< u16, revolutions per minute.
  std::size_t date_place{};  ///< u8 each: year - 1900, month, day, hour, minute, second.
  std::size_t time_place{};  ///< u32, microseconds of the second.

  [[nodiscard]] std::size_t block_size() const { return 2 + lasers * return_size; }
};

/// The properties that distinguish a Hesai sensor's packets from another's.
///
/// A firing cycle consists of one or more loops; each packet holds the blocks of whole loops. In a
/// dual return mode two blocks in succession hold the returns of one loop and have one azimuth.
struct HesaiModel {
  std::string_view name;
  HesaiLayout layout;
  std::vector<std::uint8_t> single_modes;  ///< Return modes, rising.
  std::vector<std::uint8_t> dual_modes;
  std::vector<ChannelSpec> channels;             ///< The firings of a cycle, loop by loop.
  std::vector<std::vector<std::uint8_t>> loops;  ///< The lasers of each loop's channels, from 0.
  std::int64_t loop_ns{};                        ///< From one loop to the next.
  /// Time at which the packet's last loop begins, after the time that the packet states.
  std::int64_t last_loop_ns{};
  /// Time for which the rotor has turned on from a block's azimuth when its loop begins. Absent if
  /// the sensor has already accounted for the times of the firings.
  std::optional<double> turned_us;
};

[[nodiscard]] const HesaiModel& Pandar64Model();

/// PandarXT-32, protocol 6.1.
[[nodiscard]] const HesaiModel& Xt32Model();

/// QT128C2X, protocol 3.2, with all channels, functional safety, signature and no IMU, so that a
/// packet has 1127 bytes.
[[nodiscard]] const HesaiModel& Qt128Model();

/// All of them.
[[nodiscard]] std::vector<const HesaiModel*> HesaiModels();

/// The flag that begins all packets, EE FF.
inline constexpr std::uint16_t kHesaiFlag = 0xFFEE;

}  // namespace railcast
