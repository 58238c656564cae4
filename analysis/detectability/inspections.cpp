#include "analysis/detectability/inspections.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <numbers>

#include "analysis/estimate/tolerance_limit.h"

namespace railcast {

std::vector<Inspection> InspectEach(const std::vector<InspectedApproach>& approaches) {
  constexpr double kLeast_m = 0.1;  // Things that are touched have no logarithm.
  double nearest_m = kLeast_m;
  double farthest_m = std::numeric_limits<double>::infinity();
  for (const InspectedApproach& approach : approaches) {
    nearest_m = std::max(nearest_m, approach.nearest_m);
    farthest_m = std::min(farthest_m, approach.farthest_m);
  }
  farthest_m = std::max(farthest_m, nearest_m);
  std::vector<Inspection> inspections;
  for (std::size_t i = 0; i < approaches.size(); ++i) {
    // Multiples of the golden ratio are spread evenly, however many there are.
    const double share = std::fmod((static_cast<double>(i) + 0.5) * std::numbers::phi, 1.0);
    const double distance_m = nearest_m * std::pow(farthest_m / nearest_m, share);
    inspections.push_back({.range_m = distance_m,
                           .num_detected = approaches[i].detected_m >= distance_m ? 1U : 0U,
                           .num_targets = 1});
  }
  return inspections;
}

double DistanceOf90With95(const std::vector<double>& detected_m) {
  if (detected_m.size() < DetectionFit::kMinTargets) {
    return std::numeric_limits<double>::quiet_NaN();
  }
  const double low_m = LimitsExceededBy90Percent(detected_m).low;
  return low_m > 0.0 ? low_m : std::numeric_limits<double>::quiet_NaN();
}

}  // namespace railcast
