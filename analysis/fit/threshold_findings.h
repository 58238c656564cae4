#pragma once

#include <string>

#include "analysis/estimate/estimate.h"
#include "analysis/fit/settle_threshold.h"

namespace railcast {

/// Of what the likelihood leaves open by more than 20 % either way its interval is not to be
/// trusted.
inline constexpr double kMaxLogError = 0.1;

/// e^(power x), for x of this standard error, and no surer than float32 fields are.
[[nodiscard]] Estimate Exponential(double x, double error, double power, std::uint64_t num);

/// "at least 143 m": in three digits.
[[nodiscard]] std::string Bound(const std::string& words, double bound, const std::string& unit);

/// The bound of a group that is not seen. Of a smooth threshold with the usual SNR a beam at 2/3 of
/// it still comes back once in twenty: the bound is that much looser.
[[nodiscard]] double BoundTheta(const GroupOutlook& outlook, const FitSettings& settings);

/// Why a group that is seen does not say more.
[[nodiscard]] const char* WhyVague(const FitSettings& settings);

/// Fills in reflectances and facing ranges, or why not.
void FillSurfaces(const SettledThreshold& settled,
                  const std::vector<FitSurface>& surfaces,
                  const FitSettings& settings,
                  FitResult& result);

}  // namespace railcast
