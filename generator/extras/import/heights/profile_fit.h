#pragma once

#include <functional>
#include <span>
#include <vector>

#include "railcast/alignment.h"

namespace railcast {

/// The height of a line at one chainage, as a source has it.
struct HeightSample {
  double s_m{};
  double z_m{};
};

/// What is known about a line's heights apart from its samples.
struct ProfilePrior {
  double length_m{};     ///< Length of the line; > 0.
  double sigma_m = 2.0;  ///< Standard deviation of the samples.
  /// Speed for which the line is built, by chainage. It decides how round changes of gradient are.
  std::function<double(double s_m)> speed_kmph = [](double) { return 80.0; };
};

/// Heights of a line as an alignment has them.
struct Profile {
  double start_z_m{};                           ///< At chainage 0.
  std::vector<ChainageValue> gradients_permil;  ///< At least one; the first at 0.
  double smoothing_m{};  ///< AlignmentSpec::gradient_smoothing_m that these gradients need.
  /// Heights of the samples above the profile, in their order.
  std::vector<double> offsets_m;
  /// The smallest radius of a vertical curve as a share of the one that its speed needs; infinite
  /// without any curve.
  double least_roundness{};
};

/// The vertical radius that a line for this speed has: 0.35 v^2 in m with v in km/h, with which the
/// vertical acceleration is 0.22 m/s^2 (EN 13803, recommended).
[[nodiscard]] double NeededVerticalRadius_m(double speed_kmph);

/// Steeper gradients are not fitted: 40 permil, the limit of the TSI INF for passenger lines is 35.
inline constexpr double kSteepest = 0.040;

/// Fits constant gradients to heights along a line, as few as explain them.
///
/// Knots of a polyline, first one every 100 m or every other sample, are removed one by one and
/// moved as long as that lowers the sum of squares of the samples' offsets in units of sigma (with
/// a pseudo-Huber loss that becomes linear at 2 sigma) plus 20 for each knot. Then those are
/// removed between which the needed vertical curves would not fit. Finally heights are fitted anew
/// to the polyline with its vertical curves.
/// @param samples In ascending order of their chainage, all on the line. Without any, the line is
///   level at height 0.
[[nodiscard]] Profile FitProfile(std::span<const HeightSample> samples, const ProfilePrior& prior);

}  // namespace railcast
