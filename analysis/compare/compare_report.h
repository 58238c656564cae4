#pragma once

#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "analysis/compare/ablation.h"
#include "analysis/compare/cloud_figures.h"
#include "analysis/compare/comparison.h"
#include "analysis/compare/separability.h"
#include "analysis/report/report.h"
#include "railcast/io/recording.h"

namespace railcast {

/// The words of comparisons (report/words.h).
extern const char* const kCompareWords;

/// @param pairs Read to the end.
[[nodiscard]] Report MakeCompareReport(const Comparison& comparison,
                                       const FramePairs& pairs,
                                       const RecordingInfo& a,
                                       const RecordingInfo& b,
                                       const std::string& command);

/// Defined in separability_report.cpp.
[[nodiscard]] Section MakeSeparabilitySection(const PatchPairs& patches, const Separability& told);

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
[[nodiscard]] std::string MetricsInWords();

/// The mean over the pairs, with its interval if there are enough pairs, else the bare mean.
[[nodiscard]] Cell MeanOverPairs(const Comparison& comparison, const std::string& metric);

/// Intensities of two sources that differ by hardly more than a factor, as those of drivers that
/// count from 0 to 255 and of others that count from 0 to 1 do.
struct IntensityFactor {
  double b_over_a{};      ///< Median of the ratios of the deciles.
  double largest_left{};  ///< The largest ratio of two deciles once they are scaled; 1 is none.
};

/// Compares the deciles of CloudHistograms::intensity. (Not the divergence that is left: counted
/// intensities fall into other bins once they are scaled.)
/// Returns nothing if the factor is less than two bins, or if a decile is off by more than one.
[[nodiscard]] std::optional<IntensityFactor> IntensityFactorOf(const Histogram& a,
                                                               const Histogram& b);

/// One sentence.
[[nodiscard]] std::string InWords(const IntensityFactor& factor);

}  // namespace railcast
