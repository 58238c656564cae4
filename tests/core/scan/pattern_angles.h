#pragma once

#include <cmath>
#include <cstddef>
#include <string>

#include "core/base/error.h"
#include "core/base/units.h"
#include "core/scan/scan_pattern.h"

namespace railcast {

/// A unit vector's components err by at most 2^-25 each, so its angles by some 1e-7 rad.
inline constexpr double kFloatAngle_deg = 1e-5;

/// Left positive, 0 = forward, in (-180, 180].
inline double Azimuth_deg(const ScanPattern& pattern, std::size_t i) {
  const double x = pattern.direction_x[i];
  const double y = pattern.direction_y[i];
  return DegFromRad(std::atan2(y, x));
}

inline double Elevation_deg(const ScanPattern& pattern, std::size_t i) {
  const double x = pattern.direction_x[i];
  const double y = pattern.direction_y[i];
  const double z = pattern.direction_z[i];
  return DegFromRad(std::atan2(z, std::hypot(x, y)));
}

/// What BuildScanPattern complains of; "none" if nothing.
inline std::string FaultsOf(const ScanSpec& spec) {
  try {
    static_cast<void>(BuildScanPattern(spec));
  } catch (const InputError& error) {
    return error.what();
  }
  return "none";
}

}  // namespace railcast
