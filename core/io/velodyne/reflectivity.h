#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>

namespace railcast {

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

/// Returns the intensity that a reflectivity byte stands for: the middle of its interval.
[[nodiscard]] inline float IntensityOfByte(std::uint8_t reflectivity) {
  if (reflectivity <= 100) return static_cast<float>(reflectivity) / 100.0F;
  if (reflectivity == 255) return kIdealRetroreflector;
  return std::pow(10.0F, 3.0F * (static_cast<float>(reflectivity) - 100.5F) / 154.0F);
}

}  // namespace railcast
