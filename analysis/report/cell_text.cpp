#include "analysis/report/cell_text.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>

#include "core/base/error.h"
#include "core/base/text.h"

namespace railcast {
namespace {

// Numbers beyond these are written with a power of ten.
constexpr double kLargest = 1e9;
constexpr double kSmallest = 1e-4;
// Digits of figures without an interval.
constexpr int kPlainDigits = 4;
// Digits of half an interval's width; the figure itself is rounded to the same decimal place.
constexpr int kIntervalDigits = 2;
// More digits would claim an accuracy that was not measured.
constexpr int kMaxDigits = 7;

// Decimal exponent of the first digit: 0 for 1 to 9.99, -1 for 0.1 to 0.999.
int Magnitude(double value) {
  return static_cast<int>(std::floor(std::log10(std::abs(value))));
}

std::string Printed(const char* format, int digits, double value) {
  std::array<char, 64> text{};
  std::snprintf(text.data(), text.size(), format, digits, value);
  return text.data();
}

std::string WithSeparators(const std::string& number) {
  const std::size_t first = number.find_first_of("0123456789");
  const std::size_t end = std::min(number.find('.'), number.size());
  std::string text = number.substr(0, first);
  for (std::size_t i = first; i < end; ++i) {
    if (i > first && (end - i) % 3 == 0) text += ',';
    text += number[i];
  }
  return text += number.substr(end);
}

// Rounds to a number of decimals; if it is negative, digits before the decimal point are rounded.
std::string Rounded(double value, int decimals) {
  const double step = std::pow(10.0, -decimals);
  const double rounded = decimals < 0 ? std::round(value / step) * step : value;
  const std::string text = Printed("%.*f", std::max(decimals, 0), rounded);
  // Avoid "-0.00".
  const bool is_zero = text.find_first_of("123456789") == std::string::npos;
  return WithSeparators(is_zero && text[0] == '-' ? text.substr(1) : text);
}

bool IsBeyond(double value) {
  return value != 0.0 && (std::abs(value) >= kLargest || std::abs(value) < kSmallest);
}

std::string Plain(double value) {
  if (std::isinf(value)) return value > 0.0 ? "infinite" : "-infinite";
  if (value == 0.0) return "0";
  if (IsBeyond(value)) return Printed("%.*e", kPlainDigits - 1, value);
  // Counts are shown in full, and trailing zeros are dropped.
  if (value == std::round(value)) return Rounded(value, 0);
  std::string text = Rounded(value, std::max(0, kPlainDigits - 1 - Magnitude(value)));
  if (text.find('.') == std::string::npos) return text;
  text.resize(text.find_last_not_of('0') + 1);
  if (text.back() == '.') text.pop_back();
  return text;
}

std::string IntervalText(const std::string& low, const std::string& high) {
  return Joined({"[", low, ", ", high, "]"});
}

CellText EstimateText(const Estimate& estimate) {
  CellText text;
  text.is_number = true;
  text.samples = "n = " + CountText(estimate.num);
  if (!estimate.is_enough()) {
    text.value = "not enough";
    text.is_absent = true;
    return text;
  }
  const double half_width = (estimate.high - estimate.low) / 2.0;
  if (!std::isfinite(half_width)) {
    text.value = Plain(estimate.value);
    return text;
  }
  const double largest =
      std::max({std::abs(estimate.low), std::abs(estimate.value), std::abs(estimate.high)});
  if (half_width > 0.0 && IsBeyond(largest)) {
    const int digits =
        std::clamp(Magnitude(largest) - Magnitude(half_width) + kIntervalDigits, 1, kMaxDigits);
    const auto printed = [&](double value) { return Printed("%.*e", digits - 1, value); };
    text.value = printed(estimate.value);
    text.interval = IntervalText(printed(estimate.low), printed(estimate.high));
    return text;
  }
  if (half_width <= 0.0) {
    text.value = Plain(estimate.value);
    text.interval = IntervalText(Plain(estimate.low), Plain(estimate.high));
    return text;
  }
  const int decimals =
      std::min(kIntervalDigits - 1 - Magnitude(half_width), kMaxDigits - 1 - Magnitude(largest));
  text.value = Rounded(estimate.value, decimals);
  text.interval = IntervalText(Rounded(estimate.low, decimals), Rounded(estimate.high, decimals));
  return text;
}

// What the unit of a key is that ends so; the first one that fits holds.
constexpr std::string_view kUnitsByEnd[][2] = {
    {"per_km", "1/km"},    {"per_m2", "1/m²"}, {"per_sr", "1/sr"}, {"_percent", "%"},
    {"_permil", "permil"}, {"_kmph", "km/h"},  {"_mps", "m/s"},    {"_km", "km"},
    {"_mm", "mm"},         {"_m2", "m²"},      {"_ms", "ms"},      {"_deg", "deg"},
    {"_m", "m"},           {"_s", "s"}};

TableColumn ColumnOfText(std::string_view text) {
  const std::size_t colon = text.find(": ");
  Check(colon != std::string_view::npos, "a column has a key and a title");
  TableColumn column{std::string(text.substr(0, colon)), std::string(text.substr(colon + 2))};
  if (const std::size_t bracket = column.key.find(" ["); bracket != std::string::npos) {
    column.unit = column.key.substr(bracket + 2, column.key.size() - bracket - 3);
    column.key.resize(bracket);
    return column;
  }
  const auto* const unit = std::ranges::find_if(
      kUnitsByEnd, [&](const auto& ended) { return column.key.ends_with(ended[0]); });
  if (unit != std::end(kUnitsByEnd)) column.unit = (*unit)[1];
  return column;
}

}  // namespace

std::vector<TableColumn> ColumnsOf(std::string_view text) {
  constexpr std::string_view kBetween = "; ";
  std::vector<TableColumn> columns;
  while (true) {
    const std::size_t end = text.find(kBetween);
    columns.push_back(ColumnOfText(text.substr(0, end)));
    if (end == std::string_view::npos) return columns;
    text.remove_prefix(end + kBetween.size());
  }
}

std::string CountText(std::uint64_t count) {
  return WithSeparators(std::to_string(count));
}

std::string SpanText(const Span& span) {
  return Joined({NumberText(span.low), " to ", NumberText(span.high)});
}

CellText TextOf(const Cell& cell) {
  if (const auto* const estimate = std::get_if<Estimate>(&cell)) return EstimateText(*estimate);
  CellText text;
  if (const auto* const span = std::get_if<Span>(&cell)) {
    text.value = SpanText(*span);
    return text;
  }
  if (const auto* const words = std::get_if<std::string>(&cell)) {
    text.value = *words;
    return text;
  }
  if (const auto* const judgement = std::get_if<Judgement>(&cell)) {
    text.value = judgement->words;
    return text;
  }
  text.is_number = true;
  if (const auto* const count = std::get_if<std::uint64_t>(&cell)) {
    text.value = CountText(*count);
    return text;
  }
  const double value = std::get<double>(cell);
  text.is_absent = std::isnan(value);
  text.value = text.is_absent ? "-" : Plain(value);
  return text;
}

std::string LineOf(const CellText& text) {
  if (text.is_absent) {
    return text.samples.empty() ? text.value : text.value + " (" + text.samples + ")";
  }
  std::string line = text.value;
  if (!text.interval.empty()) line += " " + text.interval;
  if (!text.samples.empty()) line += ", " + text.samples;
  return line;
}

std::string WithUnit(const std::string& title, const std::string& unit) {
  if (unit.empty()) return title;
  return title.empty() ? unit : title + " (" + unit + ")";
}

}  // namespace railcast
