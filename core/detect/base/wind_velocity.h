#pragma once

#include <cmath>

#include "core/base/units.h"
#include "railcast/effects.h"
#include "railcast/transform.h"

namespace railcast {

/// Mean velocity of the air, in world axes.
[[nodiscard]] inline Vector3 WindVelocity_mps(const WeatherSpec& weather) {
  const double from_rad = RadFromDeg(weather.wind_direction_deg);
  return -weather.wind_speed_mps * Vector3(std::cos(from_rad), std::sin(from_rad), 0.0);
}

}  // namespace railcast
