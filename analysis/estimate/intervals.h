#pragma once

#include <cstdint>

#include "analysis/estimate/estimate.h"

namespace railcast {

/// How many standard errors a 95 % interval reaches to both sides, of a normal figure.
[[nodiscard]] double NormalQuantile();
/// The same of a figure whose error was estimated with so many degrees of freedom.
[[nodiscard]] double StudentQuantile(double degrees);

/// A standard deviation of normal samples that was estimated with so many degrees of freedom, with
/// the chi-squared interval.
/// @param num Samples, for the estimate to name.
[[nodiscard]] Estimate ScaleEstimate(double scale, double degrees, std::uint64_t num);

}  // namespace railcast
