#pragma once

#include <cstddef>
#include <cstdint>

namespace railcast {

// A Pandar64 data packet, little-endian (Hesai, Pandar64 user manual, "point cloud data packet"):
//   EE FF, u8 lasers, u8 blocks, u8, u8 distance unit in mm, 2 bytes
//   6 blocks { u16 azimuth in 0.01 deg, 64 x { u16 distance, u8 reflectivity in percent } }
//   8 bytes, u16 rpm, u32 microseconds of the second, u8 return mode, u8, u8 year - 1900, u8 month,
//   u8 day, u8 hour, u8 minute, u8 second, u32 sequence number
inline constexpr std::size_t kPandar64PacketSize = 1198;
inline constexpr std::uint16_t kHesaiFlag = 0xFFEE;
inline constexpr std::size_t kPandar64LasersPlace = 2;
inline constexpr std::size_t kPandar64BlocksPlace = 3;
inline constexpr std::size_t kPandar64UnitPlace = 5;
inline constexpr std::size_t kPandar64HeaderSize = 8;
inline constexpr std::size_t kPandar64Lasers = 64;
inline constexpr std::size_t kPandar64Blocks = 6;
inline constexpr std::size_t kPandar64ReturnSize = 3;
inline constexpr std::size_t kPandar64BlockSize = 2 + kPandar64Lasers * kPandar64ReturnSize;
inline constexpr std::size_t kPandar64TailPlace =
    kPandar64HeaderSize + kPandar64Blocks * kPandar64BlockSize;
inline constexpr std::size_t kPandar64TimePlace = kPandar64TailPlace + 10;
inline constexpr std::size_t kPandar64ModePlace = kPandar64TailPlace + 14;
inline constexpr std::size_t kPandar64DatePlace = kPandar64TailPlace + 16;

inline constexpr std::uint8_t kPandar64First = 0x33;
inline constexpr std::uint8_t kPandar64Strongest = 0x37;
inline constexpr std::uint8_t kPandar64Last = 0x38;
// In these return modes, blocks come in pairs of the same azimuth, in the order that the name
// states.
inline constexpr std::uint8_t kPandar64LastAndStrongest = 0x39;
inline constexpr std::uint8_t kPandar64FirstAndLast = 0x3B;
inline constexpr std::uint8_t kPandar64FirstAndStrongest = 0x3C;

}  // namespace railcast
