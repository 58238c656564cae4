#pragma once

#include <cmath>
#include <cstddef>
#include <string>

#include "core/base/error.h"
#include "core/base/transform.h"
#include "core/base/units.h"
#include "core/scan/scan_pattern.h"

namespace railcast {

/// A unit vector's components err by at most 2^-25 each, so its angles by some 1e-7 rad.
inline constexpr double kFloatAngle_deg = 1e-5;

inline Vector3 Direction(const ScanPattern& pattern, std::size_t i) {
  return Eigen::Vector3f(pattern.direction_x[i], pattern.direction_y[i], pattern.direction_z[i])
      .cast<double>();
}

/// Degrees, left positive, 0 = forward, in (-180, 180].
inline double AzimuthInDegrees(const ScanPattern& pattern, std::size_t i) {
  const Vector3 direction = Direction(pattern, i);
  return DegFromRad(std::atan2(direction.y(), direction.x()));
}

/// Degrees, up positive.
inline double ElevationInDegrees(const ScanPattern& pattern, std::size_t i) {
  const Vector3 direction = Direction(pattern, i);
  return DegFromRad(std::atan2(direction.z(), direction.head<2>().norm()));
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
