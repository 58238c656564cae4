#include "analysis/report/axis.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <limits>

#include "analysis/report/cell_text.h"

namespace railcast {
namespace {

// Beyond these, labels have a power of ten.
constexpr double kLargestLabel = 1e6;
constexpr double kSmallestLabel = 1e-4;
// Between the outermost points and the ends of the axis.
constexpr double kMargin = 0.05;
// Values that come this near to 0, as a share of the largest, are shown with it.
constexpr double kNearZero = 0.4;
// A shorter logarithmic axis would show too few round numbers.
constexpr double kMinLogSpan = 4.0;

// Ends that grow with what is to be shown.
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

// 0.05, 1,500, 2×10⁷: `step` says how many decimals are needed.
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
    // 2.5 needs a decimal more than its power of ten.
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

// Room at both ends; `grow` says at which.
AxisRange WithMargin(Extent extent, bool is_log, bool grows_down) {
  if (is_log) {
    if (extent.high / extent.low < kMinLogSpan) {
      const double middle = std::sqrt(extent.low * extent.high);
      extent = {middle / std::sqrt(kMinLogSpan), middle * std::sqrt(kMinLogSpan)};
    }
    const double factor = std::pow(extent.high / extent.low, kMargin);
    return {extent.low / factor, extent.high * factor};
  }
  double span = extent.high - extent.low;
  if (span == 0.0) span = extent.high == 0.0 ? 1.0 : std::abs(extent.high);
  return {grows_down ? extent.low - kMargin * span : extent.low, extent.high + kMargin * span};
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
    // A decade more on both sides is enough for any interval.
    intervals.low = std::max(intervals.low, values.low / 10.0);
    intervals.high = std::min(intervals.high, values.high * 10.0);
    return WithMargin(intervals, true, true);
  }
  const bool is_positive = intervals.low >= 0.0;
  const double room = std::max(values.high - values.low, std::abs(values.high) / 2.0);
  Extent shown = {std::max(intervals.low, values.low - room),
                  std::min(intervals.high, values.high + room)};
  if (HasBars(chart) || (is_positive && shown.low < kNearZero * shown.high)) shown.Add(0.0);
  return WithMargin(shown, false, shown.low != 0.0);
}

std::optional<AxisRange> RangeOfX(const Chart& chart) {
  const auto num_categories = static_cast<double>(chart.x.categories.size());
  if (num_categories > 0.0) return AxisRange{-0.5, num_categories - 0.5};
  Extent extent;
  const std::vector<double> places = SortedPlaces(chart);
  for (const double place : places) {
    const AxisRange bar = BarAt(place, places, chart.x.is_log);
    extent.Add(bar.low);
    extent.Add(bar.high);
  }
  for (const ChartSeries& series : chart.series) {
    for (const ChartPoint& point : series.points) {
      if (HasPlace(point.x, chart.x.is_log) && HasPlace(point.y, chart.y.is_log)) {
        extent.Add(point.x);
      }
    }
  }
  if (extent.is_empty()) return std::nullopt;
  if (chart.x.is_log) return WithMargin(extent, true, true);
  // What begins at 0 shows it.
  if (extent.low > 0.0 && extent.low < kNearZero * extent.high) extent.low = 0.0;
  return WithMargin(extent, false, extent.low != 0.0);
}

std::vector<AxisTick> TicksIn(const AxisRange& range, bool is_log, int num_wanted) {
  return is_log ? LogTicks(range, num_wanted) : LinearTicks(range, num_wanted);
}

AxisRange BarAt(double x, const std::vector<double>& places, bool is_log) {
  const auto at = std::lower_bound(places.begin(), places.end(), x);
  const bool has_left = at != places.begin();
  const bool has_right = at != places.end() && at + 1 != places.end();
  if (is_log) {
    const double alone = 1.1;
    const double left = has_left ? std::sqrt(x / *(at - 1)) : 0.0;
    const double right = has_right ? std::sqrt(*(at + 1) / x) : 0.0;
    const double to_left = has_left ? left : has_right ? right : alone;
    const double to_right = has_right ? right : has_left ? left : alone;
    return {x / to_left, x * to_right};
  }
  const double alone = x == 0.0 ? 0.5 : std::abs(x) / 10.0;
  const double left = has_left ? (x - *(at - 1)) / 2.0 : 0.0;
  const double right = has_right ? (*(at + 1) - x) / 2.0 : 0.0;
  // Bars stand in the middle of their places: the nearer neighbour says how wide.
  const double half = has_left && has_right ? std::min(left, right)
                      : has_left            ? left
                      : has_right           ? right
                                            : alone;
  return {x - half, x + half};
}

std::vector<double> SortedPlaces(const Chart& chart) {
  std::vector<double> places;
  for (const ChartSeries& series : chart.series) {
    if (series.style != SeriesStyle::kBars) continue;
    for (const ChartPoint& point : series.points) {
      if (HasPlace(point.x, chart.x.is_log)) places.push_back(point.x);
    }
  }
  std::sort(places.begin(), places.end());
  places.erase(std::unique(places.begin(), places.end()), places.end());
  return places;
}

}  // namespace railcast
