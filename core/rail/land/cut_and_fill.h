#pragma once

#include <algorithm>

namespace railcast {

/// Half width of the formation beside a track's axis: the ground is level up to there. Masts stand
/// on it (their foundations reach 4.2 m).
inline constexpr double kFormationEdge_m = 4.5;

/// Rise per metre of the slopes of cuttings and embankments: 1:1.5, the usual slope of both in
/// cohesive and sandy soils (Ril 836; steeper ones need a proof of stability).
inline constexpr double kCutAndFillSlope = 1.0 / 1.5;

/// Height of the ground above the formation at `beyond_m` outside its edge: the terrain, or where
/// that is higher or lower, the slope of the cutting or the embankment.
/// @param rise_m Height of the terrain above the formation.
[[nodiscard]] inline double CutAndFill_m(double rise_m, double beyond_m) {
  const double slope_m = kCutAndFillSlope * std::max(0.0, beyond_m);
  return std::clamp(rise_m, -slope_m, slope_m);
}

}  // namespace railcast
