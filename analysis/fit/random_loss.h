#pragma once

#include <vector>

#include "analysis/estimate/estimate.h"
#include "analysis/fit/detection.h"

namespace railcast {

/// A firing whose power was far above the threshold.
struct StrongTrial {
  double range_m{};
  bool is_returned{};  ///< Also from elsewhere: the pulse was fired, and the light came back.
};

/// What takes beams whatever their power: the sensor's dropout and, growing with the way, rain's.
struct RandomLossFit {
  Estimate probability;
  Estimate rate_per_m;  ///< Not enough where it was not asked for.

  /// The estimates' values; 0 where there is none.
  [[nodiscard]] RandomLoss loss() const;
};

/// P(back) = exp(-(a + rate R)), a = -log(1 - probability), both >= 0, by maximum likelihood (it is
/// concave). Intervals from the profile likelihood: the values at which the best fit with the other
/// free has 2 log likelihood less by the quantile of chi-squared; so they hold at 0, too.
/// @param has_rate Whether rain may take any.
[[nodiscard]] RandomLossFit FitRandomLoss(const std::vector<StrongTrial>& trials, bool has_rate);

}  // namespace railcast
