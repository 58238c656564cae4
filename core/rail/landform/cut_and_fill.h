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

/// Ditches of cuttings, between the formation and the slope: trapezes with sides of 1:1.5.
inline constexpr double kDitchDepth_m = 0.4;
inline constexpr double kDitchBottom_m = 0.4;
inline constexpr double kDitchWidth_m = kDitchBottom_m + 2.0 * kDitchDepth_m / kCutAndFillSlope;

/// As CutAndFill_m(), with a ditch where the terrain is higher than the formation. It is no deeper
/// than the cutting, so that it fades out where an embankment begins.
[[nodiscard]] inline double CutWithDitchAndFill_m(double rise_m, double beyond_m) {
  if (rise_m <= 0.0) return CutAndFill_m(rise_m, beyond_m);
  const double down_m = -kCutAndFillSlope * std::max(0.0, beyond_m);
  const double up_m = kCutAndFillSlope * (beyond_m - kDitchWidth_m);
  const double ditch_m = std::max({down_m, -kDitchDepth_m, up_m});
  return std::min(rise_m, std::max(ditch_m, -rise_m));
}

}  // namespace railcast
