#pragma once

#include <cstdint>

#include "analysis/estimate/estimate.h"

namespace railcast {

/// Number of standard errors that a two-sided 95 % interval of a normal quantity reaches to each
/// side.
[[nodiscard]] double NormalQuantile();
/// As above, for a quantity whose error was estimated with so many degrees of freedom.
[[nodiscard]] double StudentQuantile(double degrees);

/// Standard deviation of normal samples, estimated with so many degrees of freedom, with its
/// chi-squared interval.
/// @param num Number of samples that the estimate states.
[[nodiscard]] Estimate ScaleEstimate(double scale, double degrees, std::uint64_t num);

}  // namespace railcast
