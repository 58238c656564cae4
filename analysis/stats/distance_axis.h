#pragma once

#include <string>

#include "analysis/report/report.h"
#include "core/io/run/dataset_files.h"

namespace railcast {

/// An axis of the bins of distance, with names that are short enough to stand below it: "10-25".
[[nodiscard]] inline ChartAxis DistanceAxis(const std::string& title) {
  ChartAxis axis{title, "m"};
  for (std::size_t i = 0; i < kNumDistanceBins; ++i) {
    const std::string from = i == 0 ? "0" : NumberText(kBinDistances_m.at(i - 1));
    axis.categories.push_back(
        i < kBinDistances_m.size() ? from + "-" + NumberText(kBinDistances_m.at(i)) : "> " + from);
  }
  return axis;
}

}  // namespace railcast
