#pragma once

#include <string>
#include <vector>

#include "analysis/detectability/detect_report.h"
#include "analysis/detectability/verdict.h"
#include "analysis/report/report.h"

namespace railcast {

/// Bins of 10 m: braking distances of 15 to 40 km/h lie 10 to 150 m apart, which 50 m bins, as
/// detection papers use them, could not tell from each other; at these speeds and 10 Hz a bin still
/// has 10 to 24 frames.
inline constexpr double kDistanceBin_m = 10.0;

/// Points on each object by its distance, over the frames of all runs up to the closest point.
[[nodiscard]] Table PointsTable(const std::vector<DetectRun>& runs, const DetectionRule& rule);

/// The same of one object, beside the rule and the distances that were needed and reached.
[[nodiscard]] Chart PointsChart(const std::vector<DetectRun>& runs,
                                const Verdict& verdict,
                                const DetectionRule& rule);

}  // namespace railcast
