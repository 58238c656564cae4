#pragma once

#include <limits>
#include <vector>

namespace railcast {

/// Where the value lies that 90 % of a population exceed, each side with 95 % confidence.
struct ToleranceLimits {
  double low = std::numeric_limits<double>::quiet_NaN();   ///< NaN with fewer than 29 values.
  double high = std::numeric_limits<double>::quiet_NaN();  ///< NaN with fewer than 2 values.
};

/// The limits by the ranks of a sample, whatever its distribution (Wilks 1941, Annals of
/// Mathematical Statistics 12): the k-th smallest value is a lower limit if fewer than k of n
/// values lie below the true one in at most 5 % of all samples, so that 29 values all exceed it, 46
/// all but one, 61 all but two.
///
///   const double d90_95_m = LimitsExceededBy90Percent(detected_m).low;
///
/// @param values Independent of each other; of what never happened, any value below all others.
[[nodiscard]] ToleranceLimits LimitsExceededBy90Percent(std::vector<double> values);

}  // namespace railcast
