#pragma once

#include <algorithm>
#include <vector>

#include "railcast/alignment.h"

namespace railcast {

/// How far the ground reaches to either side of the axis, as a function of chainage.
///
/// As far as the spec says, everywhere, if that is less than the line's tightest radius. Otherwise
/// cross-sections would meet inside tight curves, and between parts of the line that run close to
/// each other. There the ground reaches at most
///
/// - kShareOfRadius of the distance to the centre of the circle that touches the axis at the
///   cross-section and meets the axis again, at the nearest such place: in a curve the radius of
///   curvature, between two parallel parts of the line half of their distance;
/// - kNarrowing more per metre of chainage, so that the edge of the ground is smooth.
///
/// Immutable and thread-safe. Takes 16 bytes for every kStep_m of a line whose ground narrows.
class StripWidth {
 public:
  static constexpr double kShareOfRadius = 0.8;
  static constexpr double kNarrowing = 0.5;
  static constexpr double kStep_m = 5.0;

  StripWidth(const Alignment& alignment, double half_width_m);

  /// Whether the ground is narrower anywhere than the spec says.
  [[nodiscard]] bool narrows() const { return !left_m_.empty(); }
  /// Distance from the axis to the edge of the ground. @param side > 0 for the left.
  [[nodiscard]] double At(double s_m, double side) const;
  /// From a place to the nearer edge of the ground. @param d_m Left of the axis.
  [[nodiscard]] double RoomAt_m(double s_m, double d_m) const {
    return std::min(At(s_m, 1.0) - d_m, At(s_m, -1.0) + d_m);
  }
  /// The least of At().
  [[nodiscard]] double least_m() const { return least_m_; }

 private:
  double half_width_m_;
  double least_m_;
  std::vector<double> left_m_;  ///< At multiples of kStep_m.
  std::vector<double> right_m_;
};

}  // namespace railcast
