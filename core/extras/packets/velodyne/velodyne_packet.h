#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <string>

#include "core/io/datagrams.h"
#include "railcast/lidar.h"

namespace railcast {

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

/// Returns the NMEA sentence, with checksum and line end, for the second in which `time_ns` lies.
/// It gives time and date. The simulated world has no place on Earth, so the position is 0 N 0 E,
/// marked as no fix ("V"). If the position were left empty, decoders such as velodyne_decoder would
/// not read the time either.
[[nodiscard]] std::string GprmcSentence(std::int64_t time_ns);

/// Appends the 512 bytes that a sensor sends from port 8308: its clock (byte 0xC6), the state
/// "locked" of the pulse per second (0xCA) and the sentence (0xCE).
/// @param clock_ahead_ns As FrameEncoder::SetClockAhead() takes it.
void AppendPositionPacket(std::int64_t time_ns, std::int64_t clock_ahead_ns, Datagrams& datagrams);

/// Returns the file (db.xml) that tells decoders of HDL-64E, such as pcl::HDLGrabber, the angles of
/// a scan's channels, which are free for this sensor. Offsets are 0: simulated lasers are at the
/// sensor's origin.
[[nodiscard]] std::string CalibrationXml(const SpinningSpec& pattern);

}  // namespace railcast
