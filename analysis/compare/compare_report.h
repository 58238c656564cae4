#pragma once

#include <string>

#include "analysis/compare/comparison.h"
#include "analysis/compare/pairing.h"
#include "analysis/report/report.h"
#include "core/io/recording/recording.h"

namespace railcast {

/// @param pairs At its end.
[[nodiscard]] Report MakeCompareReport(const Comparison& comparison,
                                       const FramePairs& pairs,
                                       const RecordingInfo& a,
                                       const RecordingInfo& b,
                                       const std::string& command);

/// Every metric over all pairs, one a row.
[[nodiscard]] Table MetricsTable(const Comparison& comparison);

/// What the metrics mean, for a report's reader.
[[nodiscard]] std::vector<std::string> MetricsInWords();

/// Over the pairs: with its interval if there are enough; if not, the bare mean of the few.
[[nodiscard]] Cell MeanOverPairs(const Comparison& comparison, const std::string& metric);

}  // namespace railcast
