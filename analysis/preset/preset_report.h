#pragma once

#include <string>

#include "analysis/preset/preset_comparison.h"
#include "analysis/report/report.h"
#include "railcast/io/recording.h"

namespace railcast {

/// @param command Command line, for a reader to repeat.
[[nodiscard]] Report MakePresetReport(const PresetComparison& comparison,
                                      const RecordingInfo& recording,
                                      const ScenarioSpec& scenario,
                                      const std::string& command);

}  // namespace railcast
