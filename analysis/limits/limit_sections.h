#pragma once

#include <vector>

#include "analysis/report/report.h"
#include "railcast/scenario.h"

namespace railcast {

// Sections of reports that say how far simulated points can be trusted.

/// For each sensor of the sample whether it is a preset that was compared with recordings, and with
/// which result.
[[nodiscard]] Section SensorSection(const std::vector<ScenarioSpec>& sample);

/// What the sample's rungs do not model, and which way that errs.
/// @param has_detector Whether a detector decides; otherwise points on objects are counted.
[[nodiscard]] Section LimitsSection(const std::vector<ScenarioSpec>& sample, bool has_detector);

}  // namespace railcast
