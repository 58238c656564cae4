#pragma once

#include <string>
#include <vector>

#include "analysis/fit/fit.h"
#include "analysis/report/report.h"

namespace railcast {

/// What was fitted beside what was measured, as charts.
[[nodiscard]] std::vector<Chart> MakeFitCharts(const std::vector<Trial>& trials,
                                               const std::vector<FitSurface>& surfaces,
                                               const FitSettings& settings,
                                               const FitResult& result);

}  // namespace railcast
