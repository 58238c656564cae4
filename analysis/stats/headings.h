#pragma once

#include <algorithm>
#include <string>
#include <string_view>

#include "analysis/report/report.h"

namespace railcast {

/// "below threshold" of "below_threshold".
[[nodiscard]] inline std::string InWords(std::string_view key) {
  std::string words(key);
  std::ranges::replace(words, '_', ' ');
  return words;
}

/// An estimate in a chart.
[[nodiscard]] inline ChartPoint PointAt(double x, const Estimate& estimate) {
  return {x, estimate.value, estimate.low, estimate.high};
}

}  // namespace railcast
