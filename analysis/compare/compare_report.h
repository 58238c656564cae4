#pragma once

#include <string>
#include <utility>
#include <vector>

#include "analysis/compare/ablation.h"
#include "analysis/compare/comparison.h"
#include "analysis/compare/told_apart.h"
#include "analysis/report/report.h"
#include "railcast/io/recording.h"

namespace railcast {

/// @param pairs Read to the end.
[[nodiscard]] Report MakeCompareReport(const Comparison& comparison,
                                       const FramePairs& pairs,
                                       const RecordingInfo& a,
                                       const RecordingInfo& b,
                                       const std::string& command);

/// Defined in told_apart_report.cpp.
[[nodiscard]] Section MakeToldApartSection(const PatchPairs& patches, const ToldApart& told);

/// Defined in ablation_report.cpp.
/// @param facts Describe the scenario.
[[nodiscard]] Report MakeAblationReport(
    const std::vector<EffectStudy>& studies,
    const std::string& title,
    const std::vector<std::pair<std::string, std::string>>& facts,
    const std::string& command);

/// Every metric over all pairs, one per row.
[[nodiscard]] Table MetricsTable(const Comparison& comparison);

/// Explains the metrics to a reader of the report.
[[nodiscard]] std::vector<std::string> MetricsInWords();

/// The mean over the pairs, with its interval if there are enough pairs, else the bare mean.
[[nodiscard]] Cell MeanOverPairs(const Comparison& comparison, const std::string& metric);

}  // namespace railcast
