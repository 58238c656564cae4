#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "core/scan/at128.h"
#include "railcast/lidar.h"

namespace railcast {

/// The meaning of a spinning sensor's intensity bytes.
enum class IntensityBytes {
  kVelodyne,  ///< Reflectivity as defined in velodyne_packet.h.
  kPercent,
  kUnknown,     ///< No reflectivity: frames have the bytes as the foreign field "intensity_byte".
  kUnknownWide  ///< No reflectivity, 16 bits: "intensity_16_bit".
};

/// The data packets of a spinning sensor, of Velodyne or Hesai: an entry of packets.json, which has
/// the names of these members for keys.
///
/// Places are bytes from the start of a packet; 0 says that packets do not have what stands there.
/// All numbers are little-endian. Packets begin like this:
///   the header, if there is one: FF EE ...
///   blocks { u16 flag, where blocks have one; u16 azimuth in 0.01 deg, u8 in 1/256 of that if it
///            is fine; lasers x { u16 distance, u8 intensity, ... } }
/// A firing cycle consists of one or more loops. A block holds a loop, or whole cycles if it has
/// room for several; where blocks have several flags, a loop takes a block of each. In a dual
/// return mode, the blocks of a loop come twice, with one azimuth, the second time with the other
/// returns.
struct SpinningModel {
  std::string name{};      ///< Name of the sensor: "VLP-16". Models of one name stand side by side.
  std::string protocol{};  ///< As command lines and scenarios name it.
  /// Its file in scenarios/sensors, a spinning sensor; empty of AT128, whose angles depend on the
  /// unit.
  std::string sensor{};
  bool is_read = true;    ///< Whether packets can be read without knowing more of the unit.
  bool has_own_angles{};  ///< Whether each unit has angles and times of its own.
  std::vector<std::string> sends{};  ///< The return modes in which packets can be sent.

  std::size_t packet_size{};
  std::size_t header_size{};
  std::vector<std::uint8_t> version{};  ///< Bytes 2 and 3 of a header that has one.
  std::size_t lasers_place{};           ///< u8, their number.
  std::size_t blocks_place{};           ///< u8, their number.
  std::size_t unit_place{};             ///< u8, the unit of distances in mm.
  std::uint8_t unit_mm = 4;             ///< Unit that is sent, also where packets do not state it.
  /// The last byte of headers of 12 bytes: bit 0 says that the packet has a sequence number, 1
  /// values of an IMU, 2 functional safety, 3 a signature, 4 a confidence for each return. The
  /// bytes before it are the return that the first block holds (0: single, 1: the mode's first) and
  /// the number of returns.
  std::uint8_t header_flags{};
  std::string header_rule{};  ///< What is said of any other header; empty: what is wrong in it.

  std::vector<std::uint16_t> block_flags{};  ///< Flags of the blocks in turn.
  bool has_fine_azimuth{};
  std::size_t lasers{};       ///< Returns in a block.
  std::size_t blocks{};       ///< In a packet.
  std::size_t return_size{};  ///< Bytes of a laser's return.
  std::size_t loop_place{};   ///< u8, odd if the packet begins with loop 1.
  std::size_t state_place{};  ///< u16, of block b the loop, in bits 14 - 2 b and on.

  std::size_t mark_place{};  ///< u8, a value that all packets of the model have.
  std::uint8_t mark_value{};
  std::string mark_rule{};       ///< "operational state must be 0".
  std::size_t mode_place{};      ///< u8, the return mode.
  std::size_t speed_place{};     ///< u16, revolutions per minute; else known by the azimuths.
  std::size_t date_place{};      ///< u8 each: year, month, day, hour, minute, second.
  std::size_t time_place{};      ///< u32, microseconds of the second; without a date, of the hour.
  std::size_t factory_place{};   ///< u8, 0x42.
  std::size_t sequence_place{};  ///< u32, the packet's number.
  std::size_t safety_place{};    ///< Where functional safety begins.
  /// Bytes, from begin to end, whose CRC-32/MPEG-2, a u32, the packet has behind them.
  std::vector<std::pair<std::size_t, std::size_t>> checked{};
  std::vector<std::uint8_t> single_modes{};  ///< Return modes, rising.
  std::vector<std::uint8_t> dual_modes{};
  /// Whether the mode "first and last" has the last return in the first block, as all modes have
  /// that name the last.
  bool has_last_first{};
  IntensityBytes intensity = IntensityBytes::kPercent;  ///< What it is when read.

  int year_zero = 1900;  ///< Year of date byte 0; bytes from 100 on count from 1900 in any case.
  /// Whether a date of year byte 0, as all are that are sent, ends in the seconds since 1970.
  bool counts_seconds{};
  std::int64_t loop_ns{};  ///< From one loop to the next; 0 in packets.json: the sensor's cycle.
  /// Time at which the packet's last loop begins, after the time that the packet states; or its
  /// first loop, if `states_first`.
  std::int64_t stated_loop_ns{};
  bool states_first{};
  /// Time for which the rotor has turned on from a block's azimuth when its loop begins.
  double turned_us{};
  bool turns_azimuths{};  ///< Whether azimuths account for the times of the firings already.
  /// Not 0 if raw distances below 4 say why there is no point (HesaiNoPoint): what is nearer, the
  /// lasers `near_lasers` (rising), which fire for the near field, too, are blind for.
  double near_m{};
  double far_m{};  ///< As near_m, for all other lasers.
  std::vector<std::uint8_t> near_lasers{};

  /// The lasers of each loop's channels, from 0; in packets.json as ranges, from first to end.
  std::vector<std::vector<std::uint8_t>> loops{};
  std::vector<ChannelSpec> channels{};  ///< The firings of a cycle, loop by loop.
  double cycle_us{};                    ///< From one firing cycle to the next.
  /// The unit's angles if they depend on the rotor's azimuth. A turn is then the sweep of a mirror.
  std::shared_ptr<const At128Correction> correction{};

  [[nodiscard]] bool IsDual(std::uint8_t mode) const;
  /// The least raw distance that is one.
  [[nodiscard]] std::uint16_t least_distance() const { return near_m > 0.0 ? 4 : 1; }
  [[nodiscard]] std::size_t azimuth_place() const { return block_flags.empty() ? 0 : 2; }
  [[nodiscard]] std::size_t block_head_size() const {
    return azimuth_place() + (has_fine_azimuth ? 3 : 2);
  }
  [[nodiscard]] std::size_t block_size() const { return block_head_size() + lasers * return_size; }
  [[nodiscard]] std::size_t BlockPlace(std::size_t block) const {
    return header_size + block * block_size();
  }
  /// @param laser Of the block, or beyond its end of those behind it.
  [[nodiscard]] std::size_t ReturnPlace(std::size_t block, std::size_t laser) const {
    return BlockPlace(block + laser / lasers) + block_head_size() + laser % lasers * return_size;
  }
  [[nodiscard]] std::size_t blocks_per_loop() const {
    return block_flags.empty() ? 1 : block_flags.size();
  }
  [[nodiscard]] std::size_t cycles_per_block() const {
    return channels.size() < lasers ? lasers / channels.size() : 1;
  }
};

/// A firing of a model's cycle, as its channels are.
struct PacketFiring {
  std::size_t loop{};
  std::uint8_t laser{};
  std::uint16_t row{};   ///< By rising elevation.
  double turned_us{};    ///< For how long the rotor has turned on since the azimuth of the block.
  double of_cycle_us{};  ///< When its loop begins, since the cycle did.
};

/// @param channels The model's, or such as fit it.
[[nodiscard]] std::vector<PacketFiring> FiringsOf(const SpinningModel& model,
                                                  const std::vector<ChannelSpec>& channels);

/// What raw distances below 4 say where they say why there is no point.
enum class HesaiNoPoint : std::uint16_t {
  kNotFired = 0,
  kTooNear = 1,             ///< Nearer than all lasers see, or on the window.
  kTooNearForItsLaser = 2,  ///< Nearer than this laser sees.
  kNoReturn = 3,
};

// Return modes that railcast sends or treats alike. In dual ones the first of two blocks holds what
// they name first; if both are the same return, the second holds the second strongest, or a copy.
inline constexpr std::uint8_t kFirstMode = 0x33;
inline constexpr std::uint8_t kStrongestMode = 0x37;
inline constexpr std::uint8_t kLastMode = 0x38;
inline constexpr std::uint8_t kLastAndStrongestMode = 0x39;
inline constexpr std::uint8_t kFirstAndLastMode = 0x3B;

/// All models.
[[nodiscard]] const std::vector<SpinningModel>& SpinningModels();

/// The text of packets.json, of which these are.
[[nodiscard]] std::string_view PacketTable();

/// The model whose packets a protocol sends, or null if it is not one of these sensors'.
[[nodiscard]] const SpinningModel* FindSpinningModel(std::string_view protocol);

/// The model of a name, the first of several.
[[nodiscard]] const SpinningModel& ModelNamed(std::string_view name);

inline constexpr std::string_view kAt128Name = "AT128";
[[nodiscard]] SpinningModel At128Model(const std::shared_ptr<const At128Correction>& correction);

/// The flag that begins packets with a header, EE FF.
inline constexpr std::uint16_t kHesaiFlag = 0xFFEE;

}  // namespace railcast
