#pragma once

#include <optional>
#include <vector>

namespace railcast {

/// One corner of a speed profile: at a time or at a chainage (exactly one is given), a speed.
struct SpeedPoint {
  std::optional<double> time_s;
  std::optional<double> s_m;  ///< Chainage.
  double speed_mps{};         ///< >= 0.

  bool operator==(const SpeedPoint&) const = default;
};

/// How something moves along a track: constant acceleration between the points, constant speed
/// after the last and before the first. A profile is all in time or all in chainage; empty stands
/// still. `reverse` runs against the chainage: the sensor's own vehicle then looks that way too, an
/// object looks where its heading says.
struct MotionSpec {
  std::vector<SpeedPoint> profile;
  bool reverse = false;

  bool operator==(const MotionSpec&) const = default;
};

}  // namespace railcast
