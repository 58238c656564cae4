#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <string>

#include "core/io/datagrams.h"
#include "core/io/field_layout.h"
#include "core/io/scan_fit.h"

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

inline constexpr std::int64_t kUsPerHour = 3'600'000'000;

/// The intensity of reflectivity byte 255: an ideal retroreflector seen along its normal.
inline constexpr float kIdealRetroreflector = 1000.0F;

/// Returns the reflectivity byte of a frame's intensity (1 = white Lambertian at normal incidence).
///
/// Bytes 0 to 100 are diffuse reflectors in percent. Bytes 101 to 255 are retroreflectors, for
/// which the vendor states an order but no law; this one is logarithmic with 51 steps a decade: 101
/// + floor(154 log10(intensity) / 3), and 255 from kIdealRetroreflector on. NaN gives 0.
[[nodiscard]] inline std::uint8_t ReflectivityByte(float intensity) {
  constexpr float kWhite = 100.0F;
  // Written so that NaN gives 0, too.
  if (!(intensity > 0.0F)) return 0;
  if (intensity <= 1.0F) return static_cast<std::uint8_t>(std::lround(intensity * kWhite));
  const float share = std::log10(std::min(intensity, kIdealRetroreflector)) / 3.0F;
  return static_cast<std::uint8_t>(101.0F + 154.0F * std::min(share, 1.0F));
}

/// Returns the intensity that a reflectivity byte stands for: the middle of its interval. That of
/// byte 0, which a dark surface returned, too, is [0, 0.5 %).
[[nodiscard]] inline float IntensityOfByte(std::uint8_t reflectivity) {
  if (reflectivity == 0) return 0.0025F;
  if (reflectivity <= 100) return static_cast<float>(reflectivity) / 100.0F;
  if (reflectivity == 255) return kIdealRetroreflector;
  return std::pow(10.0F, 3.0F * (static_cast<float>(reflectivity) - 100.5F) / 154.0F);
}

/// Simulation time 0 in seconds since 1970: 2000-01-01 00:00:00 UTC.
inline constexpr std::int64_t kSimulationEpoch_s = 946'684'800;

/// Returns the value of Velodyne's clocks at a simulation time: microseconds past the hour.
[[nodiscard]] std::uint32_t MicrosecondsPastHour(std::int64_t time_ns);

/// Returns the NMEA sentence, with checksum and line end, for the second in which `time_ns` lies.
/// It gives time and date. The simulated world has no place on Earth, so the position is 0 N 0 E,
/// marked as no fix ("V"). If the position were left empty, decoders such as velodyne_decoder would
/// not read the time either.
[[nodiscard]] std::string GprmcSentence(std::int64_t time_ns);

/// Appends the 512 bytes that a sensor sends from port 8308: its clock (byte 0xC6), the state
/// "locked" of the pulse per second (0xCA) and the sentence (0xCE).
/// @param clock_ahead_ns As FrameEncoder::SetClockAhead() takes it.
void AppendPositionPacket(std::int64_t time_ns, std::int64_t clock_ahead_ns, Datagrams& datagrams);

}  // namespace railcast
