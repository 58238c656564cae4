#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string_view>
#include <vector>

#include "railcast/lidar.h"

namespace railcast {

/// The header of packets that begin with EE FF: where it has what.
struct HesaiHeader {
  std::size_t size{};
  std::optional<std::array<std::uint8_t, 2>> version{};  ///< Bytes 2 and 3, where they hold one.
  std::size_t lasers_place{};                            ///< u8, the number of lasers.
  std::size_t blocks_place{};                            ///< u8, the number of blocks.
  std::size_t unit_place{};                              ///< u8, the unit of distances in mm.
  /// The last byte of headers of 12 bytes: bit 0 says that the packet has a sequence number, 1
  /// values of an IMU, 2 functional safety, 3 a signature, 4 a confidence for each return. The
  /// bytes before it are the return that the first block holds (0: single, 1: the mode's first) and
  /// the number of returns.
  std::uint8_t flags{};
};

/// What the end of a packet has where.
struct HesaiTail {
  std::size_t mode_place{};     ///< u8, the return mode.
  std::size_t speed_place{};    ///< u16, revolutions per minute.
  std::size_t date_place{};     ///< u8 each: year, month, day, hour, minute, second.
  std::size_t time_place{};     ///< u32, microseconds of the second.
  std::size_t factory_place{};  ///< u8, 0x42.
  std::optional<std::size_t> sequence_place{};  ///< u32, the packet's number.
};

/// A value that all packets of a model have.
struct HesaiMark {
  std::string_view what;  ///< As messages name it: "operational state".
  std::size_t place{};    ///< u8.
  std::uint8_t value{};
};

/// Where the data packets of a Hesai sensor have what, in bytes from their start. All of them are
/// little-endian and begin like this:
///   the header, if there is one,
///   blocks { FF EE, where blocks have a flag; u16 azimuth in 0.01 deg,
///            lasers x { u16 distance, u8 reflectivity in percent, ... } }
struct HesaiLayout {
  std::size_t packet_size{};
  std::optional<HesaiHeader> header{};
  bool has_block_flags = false;
  std::size_t lasers{};
  std::size_t blocks{};
  std::size_t return_size{};                 ///< Bytes of a laser's return.
  std::optional<std::size_t> loop_place{};   ///< u8, odd if the packet begins with loop 1.
  std::optional<std::size_t> state_place{};  ///< u16, of block b the loop, in bits 14 - 2 b and on.
  std::optional<HesaiMark> mark{};
  HesaiTail tail{};
  /// Where the last of three checksums ends, in packets that have them, each a u32 CRC-32/MPEG-2.
  /// The first follows the blocks and is of them. The second ends the functional safety behind it,
  /// of kHesaiSafetySize bytes, and is of these but for the first byte. The third is of the tail.
  std::optional<std::size_t> checked_size{};

  [[nodiscard]] std::size_t header_size() const { return header ? header->size : 0; }
  [[nodiscard]] std::size_t block_head_size() const { return has_block_flags ? 4 : 2; }
  [[nodiscard]] std::size_t block_size() const { return block_head_size() + lasers * return_size; }
  /// The place of a block.
  [[nodiscard]] std::size_t BlockPlace(std::size_t block) const {
    return header_size() + block * block_size();
  }
};

/// Bytes of the functional safety that follows the blocks and their CRC.
inline constexpr std::size_t kHesaiSafetySize = 17;

/// How near a laser must be to something to be blind for it.
struct HesaiNearLimits {
  double near_m{};                        ///< Of lasers that fire for the near field, too.
  double far_m{};                         ///< Of all others.
  std::vector<std::uint8_t> near_lasers;  ///< Those of near_m, rising.
};

/// The properties that distinguish a Hesai sensor's packets from another's.
///
/// A firing cycle consists of one or more loops; each packet holds the blocks of whole loops. In a
/// dual return mode two blocks in succession hold the returns of one loop and have one azimuth.
struct HesaiModel {
  std::string_view name;
  std::string_view protocol;  ///< As command lines and scenarios name it.
  HesaiLayout layout{};
  std::vector<std::uint8_t> single_modes{};  ///< Return modes, rising.
  std::vector<std::uint8_t> dual_modes{};
  /// Whether the mode "first and last" has the last return in the first block, as all modes have
  /// that name the last.
  bool has_last_first = false;
  std::vector<ChannelSpec> channels{};             ///< The firings of a cycle, loop by loop.
  std::vector<std::vector<std::uint8_t>> loops{};  ///< The lasers of each loop's channels, from 0.
  std::int64_t loop_ns{};                          ///< From one loop to the next.
  /// Time at which the packet's last loop begins, after the time that the packet states; or its
  /// first loop, if `states_first`.
  std::int64_t stated_loop_ns{};
  bool states_first = false;
  /// Time for which the rotor has turned on from a block's azimuth when its loop begins. Absent if
  /// the sensor has already accounted for the times of the firings.
  std::optional<double> turned_us{};
  /// Year of date byte 0; bytes from 100 on count from 1900 in any case.
  int year_zero = 1900;
  /// Whether the byte behind a distance is a reflectivity in percent. If not, its scale is not
  /// known.
  bool has_reflectivity = true;
  /// Present if the least distances say why there is no point (HesaiNoPoint).
  std::optional<HesaiNearLimits> near_limits{};

  [[nodiscard]] bool IsDual(std::uint8_t mode) const;
  /// The least raw distance that is one.
  [[nodiscard]] std::uint16_t least_distance() const { return near_limits ? 4 : 1; }
};

/// What raw distances below 4 say where they say why there is no point.
enum class HesaiNoPoint : std::uint16_t {
  kNotFired = 0,
  kTooNear = 1,             ///< Nearer than all lasers see, or on the window.
  kTooNearForItsLaser = 2,  ///< Nearer than this laser sees.
  kNoReturn = 3,
};

// Return modes that railcast sends or treats alike.
inline constexpr std::uint8_t kHesaiFirst = 0x33;
inline constexpr std::uint8_t kHesaiStrongest = 0x37;
inline constexpr std::uint8_t kHesaiLast = 0x38;
inline constexpr std::uint8_t kHesaiLastAndStrongest = 0x39;
inline constexpr std::uint8_t kHesaiFirstAndLast = 0x3B;

/// All models, those of which two have one name (with and without sequence numbers) side by side.
[[nodiscard]] const std::vector<HesaiModel>& HesaiModels();

/// The model whose packets a protocol sends, or null if it is not one of Hesai's.
[[nodiscard]] const HesaiModel* FindHesaiModel(std::string_view protocol);

/// The unit of distances that all these sensors use, whether their packets state it or not.
inline constexpr std::uint8_t kHesaiUnit_mm = 4;

/// The flag that begins packets with a header, EE FF.
inline constexpr std::uint16_t kHesaiFlag = 0xFFEE;
/// The flag that begins blocks that have one, FF EE.
inline constexpr std::uint16_t kHesaiBlockFlag = 0xEEFF;

}  // namespace railcast
