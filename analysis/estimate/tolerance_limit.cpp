#include "analysis/estimate/tolerance_limit.h"

#include <algorithm>
#include <boost/math/distributions/binomial.hpp>
#include <cstddef>

namespace railcast {

ToleranceLimits LimitsExceededBy90Percent(std::vector<double> values) {
  constexpr double kShareBelow = 0.1;
  constexpr double kRisk = 0.05;
  std::ranges::sort(values);
  const boost::math::binomial below(static_cast<double>(values.size()), kShareBelow);
  ToleranceLimits limits;
  for (std::size_t i = 0; i < values.size(); ++i) {
    // That at most i values lie below the one that is sought.
    const double probability = boost::math::cdf(below, static_cast<double>(i));
    if (probability <= kRisk) limits.low = values[i];
    if (probability >= 1.0 - kRisk) {
      limits.high = values[i];
      break;
    }
  }
  return limits;
}

}  // namespace railcast
