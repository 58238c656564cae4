#pragma once

#include <string>
#include <vector>

#include "analysis/detectability/object_detection.h"
#include "analysis/estimate/detection_curve.h"
#include "analysis/report/report.h"

namespace railcast {

/// How probably an object is detected by a distance.
struct DetectionProbability {
  std::string name;                     ///< The object's.
  std::vector<Inspection> inspections;  ///< One of each run that approaches it.
  DetectionFit fit;
};

/// Inspects an object once in each run that approaches it: whether it has been detected by the time
/// it is at a distance. The distances are spread evenly over the logarithm of those that all runs
/// have, so that inspections are independent of each other, as the fit assumes.
/// @param runs In the order of their seeds.
[[nodiscard]] DetectionProbability ProbabilityOf(const std::vector<DetectRun>& runs,
                                                 const std::string& object);

/// The section of the probabilities of all objects in the way: for each a curve, and the distance
/// by which it is detected with a probability of 0.9, with 95 % confidence; or a line where
/// inspections are too few.
[[nodiscard]] Section MakeProbabilitySection(const std::vector<DetectRun>& runs,
                                             const std::vector<Verdict>& verdicts);

}  // namespace railcast
