#pragma once

#include <cmath>
#include <cstddef>
#include <string>

#include "core/base/units.h"
#include "railcast/lidar.h"
#include "railcast/transform.h"
#include "tests/core/io/message_of.h"

namespace railcast {

/// Each component of a unit vector has an error of at most 2^-25, so angles have errors of about
/// 1e-7 rad.
inline constexpr double kFloatAngle_deg = 1e-5;

inline Vector3 Direction(const ScanPattern& pattern, std::size_t i) {
  return Eigen::Vector3f(pattern.direction_x[i], pattern.direction_y[i], pattern.direction_z[i])
      .cast<double>();
}

/// Azimuth in degrees, left positive, 0 = forward, in (-180, 180].
inline double AzimuthInDegrees(const ScanPattern& pattern, std::size_t i) {
  const Vector3 direction = Direction(pattern, i);
  return DegFromRad(std::atan2(direction.y(), direction.x()));
}

/// Elevation in degrees, up positive.
inline double ElevationInDegrees(const ScanPattern& pattern, std::size_t i) {
  const Vector3 direction = Direction(pattern, i);
  return DegFromRad(std::atan2(direction.z(), direction.head<2>().norm()));
}

/// Text of the faults that BuildScanPattern reports; "no error" if there are none.
inline std::string FaultsOf(const ScanSpec& spec) {
  return MessageOf([&] { static_cast<void>(BuildScanPattern(spec)); });
}

}  // namespace railcast
