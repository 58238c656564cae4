#pragma once

#include <array>
#include <cstdint>
#include <string_view>

namespace railcast {

/// What became of one firing. Every firing has exactly one, in its first slot, also those without a
/// point: this is what makes dropout analysis exact.
enum class Outcome : std::uint8_t {
  kReturned = 0,        ///< A surface returned.
  kNoSurface = 1,       ///< Nothing within range_max_m.
  kOutOfRange = 2,      ///< The measured range lies beyond the sensor's gate.
  kBelowThreshold = 3,  ///< Too little power came back.
  kRainAbsorbed = 4,    ///< Lost to rain on the way.
  kClutter = 5,         ///< Rain, snow or fog returned instead.
  kNearRange = 6,       ///< Blocked by something nearer than range_min_m.
  kEgo = 7,             ///< Blocked by the vehicle itself.
  kSensorDropout = 8,   ///< The sensor missed the pulse.
  kNoFurtherEcho = 9,   ///< Of a second or third slot: nothing more came back.
};

inline constexpr std::array<std::string_view, 10> kOutcomeNames = {
    "returned", "no_surface", "out_of_range", "below_threshold", "rain_absorbed",
    "clutter",  "near_range", "ego",          "sensor_dropout",  "no_further_echo",
};

[[nodiscard]] constexpr std::string_view OutcomeName(Outcome outcome) {
  return kOutcomeNames[static_cast<std::size_t>(outcome)];
}

/// Whether the firing has a point: x, y, z, range_m are numbers, not NaN.
[[nodiscard]] constexpr bool HasPoint(Outcome outcome) {
  return outcome == Outcome::kReturned || outcome == Outcome::kClutter;
}

}  // namespace railcast
