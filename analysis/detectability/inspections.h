#pragma once

#include <limits>
#include <vector>

#include "analysis/estimate/detection_curve.h"

namespace railcast {

/// An approach to an object: from which distance to which, and where it was detected.
struct InspectedApproach {
  double nearest_m{};
  double farthest_m{};
  double detected_m = std::numeric_limits<double>::quiet_NaN();  ///< NaN = not at all.
};

/// Inspects the object of each approach once: whether it has been detected by the time that it is
/// at a distance. The distances are spread evenly over the logarithm of those that all approaches
/// have, so that inspections are independent of each other, as FitDetection() assumes.
/// @return As many as approaches, in their order.
[[nodiscard]] std::vector<Inspection> InspectEach(const std::vector<InspectedApproach>& approaches);

/// The distance by which 90 % of approaches detect their object with 95 % confidence, by ranks. NaN
/// with fewer than DetectionFit::kMinTargets, or without such a distance.
/// @param detected_m Of each approach; 0 without detection.
[[nodiscard]] double DistanceOf90With95(const std::vector<double>& detected_m);

}  // namespace railcast
