#pragma once

#include <cstdint>
#include <numbers>

namespace railcast {

inline constexpr std::int64_t kNsPerS = 1'000'000'000;
inline constexpr std::int64_t kNsPerUs = 1000;

/// In vacuum, exact by definition of the metre.
inline constexpr double kSpeedOfLight_mps = 299'792'458.0;

[[nodiscard]] constexpr double RadFromDeg(double angle_deg) {
  return angle_deg * (std::numbers::pi / 180.0);
}
[[nodiscard]] constexpr double DegFromRad(double angle_rad) {
  return angle_rad * (180.0 / std::numbers::pi);
}
[[nodiscard]] constexpr double MpsFromKmph(double speed_kmph) {
  return speed_kmph / 3.6;
}
[[nodiscard]] constexpr double SecondsFromNs(std::int64_t time_ns) {
  return static_cast<double>(time_ns) * 1e-9;
}

}  // namespace railcast
