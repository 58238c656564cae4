#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <string_view>

namespace railcast {

/// The fate of one firing.
///
/// Every firing has exactly one outcome, stored in its first slot, even if it yields no point.
/// Dropout can therefore be analysed exactly.
enum class Outcome : std::uint8_t {
  kReturned = 0,        ///< A surface returned an echo.
  kNoSurface = 1,       ///< No surface within range_max_m.
  kOutOfRange = 2,      ///< The measured range lies beyond the sensor's range gate.
  kBelowThreshold = 3,  ///< The received power is below the detection threshold.
  kRainAbsorbed = 4,    ///< Absorbed by rain on the way.
  kClutter = 5,         ///< Rain, snow, fog, a mirror image or the sensor itself gave an echo.
  kNearRange = 6,       ///< Blocked by a surface nearer than range_min_m.
  kEgo = 7,             ///< Blocked by the vehicle's own body.
  kSensorDropout = 8,   ///< The sensor missed the pulse.
  kNoFurtherEcho = 9,   ///< Second or third slot of a firing that has no further echo.
  kCoverBlocked = 10,   ///< Lost to drops, dirt or snow on the sensor's window.
};

inline constexpr std::array<std::string_view, 11> kOutcomeNames = {
    "returned",   "no_surface", "out_of_range",   "below_threshold", "rain_absorbed", "clutter",
    "near_range", "ego",        "sensor_dropout", "no_further_echo", "cover_blocked",
};

/// The name of an outcome in files and messages: "rain_absorbed".
[[nodiscard]] constexpr std::string_view OutcomeName(Outcome outcome) {
  return kOutcomeNames[static_cast<std::size_t>(outcome)];
}

/// Whether a slot with this outcome has a point, that is, its x, y, z and range_m are not NaN.
[[nodiscard]] constexpr bool HasPoint(Outcome outcome) {
  return outcome == Outcome::kReturned || outcome == Outcome::kClutter;
}

}  // namespace railcast
