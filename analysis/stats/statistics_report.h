#pragma once

#include <string>
#include <vector>

#include "analysis/report/report.h"
#include "analysis/stats/statistics.h"
#include "core/io/recording/recording.h"

namespace railcast {

/// @param sources What was measured, one or more, all with the same labels and materials.
/// @param command As it was called, for a reader to repeat.
[[nodiscard]] Report MakeStatisticsReport(const Statistics& statistics,
                                          const std::vector<RecordingInfo>& sources,
                                          const std::string& command);

}  // namespace railcast
