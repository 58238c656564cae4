#pragma once

#include <map>

#include "analysis/estimate/estimate.h"
#include "analysis/fit/recorded_trials.h"

namespace railcast {

/// Random losses of firings that meet a surface: P(point) = (1 - probability) exp(-rate R).
struct RandomLoss {
  Estimate probability;
  Estimate rate_per_m;

  /// P(no point); NaN where nothing was fitted.
  [[nodiscard]] double At(double range_m) const;
};

/// Maximum likelihood under probability >= 0 and rate >= 0; with a = -log(1 - probability) it is
/// concave in (a, rate). The intervals come from the profile likelihood, which also holds at 0:
/// they contain all values of one parameter for which the best fit over the other has 2 log
/// likelihood less than the maximum by at most the quantile of chi-squared with one degree of
/// freedom. Firings are assumed to be independent; those on one dark spot are not.
[[nodiscard]] RandomLoss FitRandomLoss(const std::map<int, LossBin>& bins);

}  // namespace railcast
