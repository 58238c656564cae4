#pragma once

#include <optional>
#include <string>
#include <vector>

#include "analysis/report/report.h"

namespace railcast {

/// Ends of an axis.
struct AxisRange {
  double low{};
  double high = 1.0;
};

struct AxisTick {
  double at{};
  std::string label;
};

/// Whether a value can be drawn on an axis.
[[nodiscard]] bool HasPlace(double value, bool is_log);

/// The range of y that shows all values of a chart and, unless they are far wider than the values
/// themselves, all intervals. Returns nothing if no point can be drawn.
[[nodiscard]] std::optional<AxisRange> RangeOfY(const Chart& chart);

/// The range of x.
[[nodiscard]] std::optional<AxisRange> RangeOfX(const Chart& chart);

/// Round numbers within a range, about `num_wanted` of them. gnuplot's own have no label on a
/// logarithmic axis but at powers of ten, none at all from 20 to 60, and say 2e+07 where these say
/// 2×10⁷, and 1400 for 1,400.
[[nodiscard]] std::vector<AxisTick> TicksIn(const AxisRange& range, bool is_log, int num_wanted);

}  // namespace railcast
