#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <cstring>

namespace railcast {

// A Velodyne data packet, little-endian:
//   12 blocks { u16 flag, u16 azimuth in 0.01 deg, 32 x { u16 distance, u8 reflectivity } }
//   u32 microseconds past the hour of the first firing, u8 return mode, u8 model
// (VLP-16 user manual 63-9243, chapter 9; HDL-64E's last two bytes have other meanings.)
inline constexpr std::size_t kVelodynePacketSize = 1206;
inline constexpr std::size_t kBlocksPerPacket = 12;
inline constexpr std::size_t kBlockSize = 100;
inline constexpr std::size_t kLasersPerBlock = 32;
inline constexpr std::size_t kAzimuthPlace = 2;  ///< In a block.
inline constexpr std::size_t kReturnsPlace = 4;  ///< In a block.
inline constexpr std::size_t kReturnSize = 3;
inline constexpr std::size_t kTimePlace = 1200;
inline constexpr std::size_t kModePlace = 1204;
inline constexpr std::size_t kModelPlace = 1205;

inline constexpr std::uint16_t kLowerBlockFlag = 0xEEFF;  ///< Lasers 0 to 31.
inline constexpr std::uint16_t kUpperBlockFlag = 0xDDFF;  ///< Lasers 32 to 63.
/// The flags of the blocks of a cycle; VLS-128 has all four, HDL-64E the first two.
inline constexpr std::array<std::uint16_t, 4> kBlockFlags = {kLowerBlockFlag, kUpperBlockFlag,
                                                             0xCCFF, 0xBBFF};

inline constexpr std::uint8_t kStrongestMode = 0x37;
inline constexpr std::uint8_t kLastMode = 0x38;
/// Dual returns: blocks come in pairs, of which the even one holds the last return and the odd one
/// the strongest. If both are the same return, the odd block holds the second strongest, or a copy.
inline constexpr std::uint8_t kDualMode = 0x39;

inline constexpr std::int64_t kAzimuthUnitsPerTurn = 36'000;
inline constexpr double kAzimuthUnit_deg = 0.01;
inline constexpr std::int64_t kUsPerHour = 3'600'000'000;

/// Reads a number at an address of any alignment.
template <typename Number>
[[nodiscard]] Number LoadAt(const char* place) {
  Number number{};
  std::memcpy(&number, place, sizeof number);
  return number;
}

}  // namespace railcast
