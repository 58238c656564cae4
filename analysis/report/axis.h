#pragma once

#include <optional>
#include <string>
#include <vector>

#include "analysis/report/report.h"

namespace railcast {

/// Where an axis begins and ends.
struct AxisRange {
  double low{};
  double high = 1.0;
};

struct AxisTick {
  double at{};
  std::string label;
};

/// Whether a value has a place on an axis.
[[nodiscard]] bool HasPlace(double value, bool is_log);

/// The range of y that shows all values of a chart and, unless they are far wider than the values
/// themselves, all intervals. Nothing if no point has a place.
[[nodiscard]] std::optional<AxisRange> RangeOfY(const Chart& chart);

/// The range of x; half a bar more on both sides where there are bars.
[[nodiscard]] std::optional<AxisRange> RangeOfX(const Chart& chart);

/// Round numbers within a range, about `num_wanted` of them.
[[nodiscard]] std::vector<AxisTick> TicksIn(const AxisRange& range, bool is_log, int num_wanted);

/// Where the bar at a place begins and ends: halfway to its neighbours (on a logarithmic axis
/// halfway between their logarithms), without a gap for the eye. `places` ascend, as of
/// SortedPlaces.
[[nodiscard]] AxisRange BarAt(double x, const std::vector<double>& places, bool is_log);

/// Every x of the chart's bars, each once, ascending.
[[nodiscard]] std::vector<double> SortedPlaces(const Chart& chart);

}  // namespace railcast
