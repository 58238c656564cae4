#pragma once

#include <string>
#include <vector>

#include "analysis/detectability/object_detection.h"
#include "analysis/estimate/detection_curve.h"
#include "analysis/report/report.h"

namespace railcast {

/// The section of the probabilities of all objects in the way: for each a curve, and the distance
/// by which it is detected with a probability of 0.9, with 95 % confidence; or a line where
/// inspections are too few.
/// @param runs In the order of their seeds. Each is inspected once.
[[nodiscard]] Section MakeProbabilitySection(const std::vector<DetectRun>& runs,
                                             const std::vector<Verdict>& verdicts);

/// Which share of the approaches had detected one object by a distance, the curve with its
/// inspections where there is one, and d90/95.
/// @param detected_m Of each approach; 0 without detection. Not empty.
[[nodiscard]] Chart ProbabilityChart(const std::string& object,
                                     const std::vector<double>& detected_m,
                                     const std::vector<Inspection>& inspected,
                                     const DetectionFit& fit);

/// Blank unless it is estimated: an asymptote that is not is 1 by assumption.
[[nodiscard]] Cell AsymptoteCell(const DetectionFit& fit);

}  // namespace railcast
