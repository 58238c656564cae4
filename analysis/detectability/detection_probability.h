#pragma once

#include <limits>
#include <string>
#include <vector>

#include "analysis/detectability/object_detection.h"
#include "analysis/estimate/detection_curve.h"
#include "analysis/report/report.h"

namespace railcast {

/// An approach to an object: from which distance to which, and where it was detected.
struct InspectedApproach {
  double nearest_m{};
  double farthest_m{};
  double detected_m = std::numeric_limits<double>::quiet_NaN();  ///< NaN = not at all.
};

/// Inspects the object of each approach once: whether it has been detected by the time that it is
/// at a distance. The distances are spread evenly over the logarithm of those that all approaches
/// have, so that inspections are independent of each other, as FitDetection() assumes.
/// @return As many as approaches, in their order.
[[nodiscard]] std::vector<Inspection> InspectEach(const std::vector<InspectedApproach>& approaches);

/// The distance by which 90 % of approaches detect their object with 95 % confidence, by ranks. NaN
/// with fewer than DetectionFit::kMinTargets, or without such a distance.
/// @param detected_m Of each approach; 0 without detection.
[[nodiscard]] double DistanceOf90With95(const std::vector<double>& detected_m);

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
