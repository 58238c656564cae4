#pragma once

#include <string>
#include <vector>

#include "analysis/detectability/detect_report.h"
#include "analysis/detectability/verdict.h"
#include "analysis/report/report.h"

namespace railcast {

/// Bins of 10 m: the braking distances from 15 to 40 km/h lie 10 to 150 m apart, so the 50 m bins
/// usual in detection papers could not separate them; at these speeds and 10 Hz a bin still holds
/// 10 to 24 frames.
inline constexpr double kDistanceBin_m = 10.0;

/// Number of points on each object by distance, over the frames of all runs up to the closest
/// point.
[[nodiscard]] Table PointsTable(const std::vector<DetectRun>& runs, const DetectionRule& rule);

/// Key such as "points_wagon_1", unique for each name of an object, since it becomes a file name.
[[nodiscard]] std::string KeyOfObject(const std::string& prefix, const std::string& name);

/// The points of one object, with the rule and the distances needed and reached.
[[nodiscard]] Chart PointsChart(const std::vector<DetectRun>& runs,
                                const Verdict& verdict,
                                const DetectionRule& rule);

}  // namespace railcast
