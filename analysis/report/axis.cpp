#include "analysis/report/chart_script.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>

#include "analysis/report/cell_text.h"

namespace railcast {
namespace {

// Labels beyond these are written with a power of ten.
constexpr double kLargestLabel = 1e6;
constexpr double kSmallestLabel = 1e-4;
// Margin between the outermost points and the ends of the axis.
constexpr double kMargin = 0.05;
// Margin where points have labels, and the additional one at the left end of a logarithmic axis.
constexpr double kLabelMargin = 0.1;
constexpr double kLabelRoom = 0.12;
// If the smallest value is less than this share of the largest, the axis begins at 0.
constexpr double kNearZero = 0.4;
// A shorter logarithmic axis would show too few round numbers.
constexpr double kMinLogSpan = 4.0;

// Smallest and largest of the values added so far.
struct Extent {
  double low = std::numeric_limits<double>::infinity();
  double high = -std::numeric_limits<double>::infinity();

  void Add(double value) {
    low = std::min(low, value);
    high = std::max(high, value);
  }
  [[nodiscard]] bool is_empty() const { return low > high; }
};

std::string Superscript(int number) {
  constexpr std::array<const char*, 10> kDigits = {"⁰", "¹", "²", "³", "⁴",
                                                   "⁵", "⁶", "⁷", "⁸", "⁹"};
  std::string text = number < 0 ? "⁻" : "";
  for (const char digit : std::to_string(std::abs(number))) {
    text += kDigits[static_cast<std::size_t>(digit - '0')];
  }
  return text;
}

// Label such as 0.05, 1,500 or 2×10⁷; `step` determines the number of decimals.
std::string TickLabel(double value, double step) {
  if (std::abs(value) < 1e-9 * step) return "0";
  const double size = std::abs(value);
  std::array<char, 32> text{};
  if (size >= kLargestLabel || step < kSmallestLabel) {
    const int power = static_cast<int>(std::floor(std::log10(size) + 1e-9));
    std::snprintf(text.data(), text.size(), "%.4g", value / std::pow(10.0, power));
    const std::string factor = text.data();
    std::string label = factor == "1" ? "" : factor == "-1" ? "−" : factor + "×";
    label += "10" + Superscript(power);
    return label;
  }
  const int decimals = std::max(0, static_cast<int>(std::ceil(-std::log10(step) - 1e-9)));
  std::snprintf(text.data(), text.size(), "%.*f", decimals, size);
  std::string label = text.data();
  if (size >= 1000.0 && decimals == 0)
    label = CountText(static_cast<std::uint64_t>(std::llround(size)));
  return value < 0.0 ? "−" + label : label;
}

std::vector<AxisTick> LinearTicks(const AxisRange& range, int num_wanted) {
  const double rough = (range.high - range.low) / num_wanted;
  const double power = std::pow(10.0, std::floor(std::log10(rough)));
  double step = 10.0 * power;
  for (const double factor : {1.0, 2.0, 2.5, 5.0}) {
    if (factor * power >= rough * (1.0 - 1e-9)) {
      step = factor * power;
      break;
    }
  }
  std::vector<AxisTick> ticks;
  const double first = std::ceil(range.low / step - 1e-9);
  for (double i = first; i * step <= range.high + 1e-9 * step; ++i) {
    // A step of 2.5 needs one decimal more than its power of ten.
    const bool is_quarter = std::abs(step / power - 2.5) < 1e-9;
    ticks.push_back({i * step, TickLabel(i * step, is_quarter ? power / 10.0 : step)});
  }
  return ticks;
}

std::vector<AxisTick> LogTicks(const AxisRange& range, int num_wanted) {
  const int first = static_cast<int>(std::floor(std::log10(range.low)));
  const int last = static_cast<int>(std::ceil(std::log10(range.high)));
  const double num_decades = std::log10(range.high / range.low);
  const std::vector<double> factors = 3.0 * num_decades <= 1.5 * num_wanted
                                          ? std::vector<double>{1.0, 2.0, 5.0}
                                          : std::vector<double>{1.0};
  const int stride = std::max(1, static_cast<int>(num_decades / num_wanted));
  std::vector<AxisTick> ticks;
  for (int power = first; power <= last; ++power) {
    if (power % stride != 0) continue;
    for (const double factor : factors) {
      const double at = factor * std::pow(10.0, power);
      if (at < range.low * (1.0 - 1e-9) || at > range.high * (1.0 + 1e-9)) continue;
      ticks.push_back({at, TickLabel(at, std::pow(10.0, power))});
    }
  }
  return ticks;
}

// Adds a margin at the upper end and, if `grows_down`, at the lower end.
AxisRange WithMargin(Extent extent, bool is_log, bool grows_down, double margin) {
  if (is_log) {
    if (extent.high / extent.low < kMinLogSpan) {
      const double middle = std::sqrt(extent.low * extent.high);
      extent = {middle / std::sqrt(kMinLogSpan), middle * std::sqrt(kMinLogSpan)};
    }
    const double factor = std::pow(extent.high / extent.low, margin);
    return {extent.low / factor, extent.high * factor};
  }
  double span = extent.high - extent.low;
  if (span == 0.0) span = extent.high == 0.0 ? 1.0 : std::abs(extent.high);
  return {grows_down ? extent.low - margin * span : extent.low, extent.high + margin * span};
}

double MarginOf(const Chart& chart) {
  for (const ChartSeries& series : chart.series) {
    for (const ChartPoint& point : series.points) {
      if (!point.label.empty()) return kLabelMargin;
    }
  }
  return kMargin;
}

bool HasBars(const Chart& chart) {
  return std::any_of(chart.series.begin(), chart.series.end(),
                     [](const ChartSeries& s) { return s.style == SeriesStyle::kBars; });
}

}  // namespace

bool HasPlace(double value, bool is_log) {
  return std::isfinite(value) && (!is_log || value > 0.0);
}

std::optional<AxisRange> RangeOfY(const Chart& chart) {
  const bool is_log = chart.y.is_log;
  Extent values, intervals;
  for (const ChartSeries& series : chart.series) {
    for (const ChartPoint& point : series.points) {
      if (!HasPlace(point.x, chart.x.is_log) || !HasPlace(point.y, is_log)) continue;
      values.Add(point.y);
      intervals.Add(point.y);
      if (HasPlace(point.low, is_log)) intervals.Add(point.low);
      if (HasPlace(point.high, is_log)) intervals.Add(point.high);
    }
  }
  if (values.is_empty()) return std::nullopt;
  if (is_log) {
    // Show at most one decade beyond the values on either side, so that wide intervals do not
    // compress them.
    intervals.low = std::max(intervals.low, values.low / 10.0);
    intervals.high = std::min(intervals.high, values.high * 10.0);
    return WithMargin(intervals, true, true, MarginOf(chart));
  }
  const bool is_positive = intervals.low >= 0.0;
  const double room = std::max(values.high - values.low, std::abs(values.high) / 2.0);
  Extent shown = {std::max(intervals.low, values.low - room),
                  std::min(intervals.high, values.high + room)};
  if (HasBars(chart) || (is_positive && shown.low < kNearZero * shown.high)) shown.Add(0.0);
  return WithMargin(shown, false, shown.low != 0.0, MarginOf(chart));
}

std::optional<AxisRange> RangeOfX(const Chart& chart) {
  const auto num_categories = static_cast<double>(chart.x.categories.size());
  if (num_categories > 0.0) return AxisRange{-0.5, num_categories - 0.5};
  Extent extent;
  for (const ChartSeries& series : chart.series) {
    for (const ChartPoint& point : series.points) {
      if (HasPlace(point.x, chart.x.is_log) && HasPlace(point.y, chart.y.is_log)) {
        extent.Add(point.x);
      }
    }
  }
  if (extent.is_empty()) return std::nullopt;
  if (chart.x.is_log) {
    AxisRange range = WithMargin(extent, true, true, MarginOf(chart));
    if (MarginOf(chart) > kMargin) range.low /= std::pow(range.high / range.low, kLabelRoom);
    return range;
  }
  // An axis that begins at 0 needs no margin there.
  if (extent.low > 0.0 && extent.low < kNearZero * extent.high) extent.low = 0.0;
  return WithMargin(extent, false, extent.low != 0.0, MarginOf(chart));
}

std::vector<AxisTick> TicksIn(const AxisRange& range, bool is_log, int num_wanted) {
  return is_log ? LogTicks(range, num_wanted) : LinearTicks(range, num_wanted);
}

}  // namespace railcast
