#include "generator/import/lines/line_gauge.h"

#include <algorithm>
#include <charconv>
#include <map>

namespace railcast {
namespace {

/// A gauge that an alignment can have (AlignmentSpec::gauge_mm).
std::optional<double> GaugeIn_mm(std::string_view text) {
  double gauge_mm = 0.0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), gauge_mm);
  if (error != std::errc{} || end != text.data() + text.size()) return std::nullopt;
  const bool is_one = gauge_mm >= kNarrowestGauge_mm && gauge_mm <= kWidestGauge_mm;
  return is_one ? std::optional(gauge_mm) : std::nullopt;
}

}  // namespace

std::optional<double> GaugeOf_mm(std::string_view gauge) {
  std::optional<double> first_mm;
  while (true) {
    const std::size_t end = std::min(gauge.find(';'), gauge.size());
    std::string_view one = gauge.substr(0, end);
    while (one.starts_with(' ')) one.remove_prefix(1);
    const std::optional<double> gauge_mm = GaugeIn_mm(one);
    if (gauge_mm == kStandardGauge_mm) return gauge_mm;
    if (!first_mm) first_mm = gauge_mm;
    if (end == gauge.size()) return first_mm;
    gauge.remove_prefix(end + 1);
  }
}

double GaugeAlong_mm(const RailMap& map, const TrackLine& line) {
  std::map<double, double> lengths_m;
  for (std::size_t i = 0; i < line.ways.size(); ++i) {
    const std::optional<double> gauge_mm = GaugeOf_mm(TagOf(map.ways[line.ways[i]].tags, "gauge"));
    lengths_m[gauge_mm.value_or(kStandardGauge_mm)] += StepLength_m(map, line, i);
  }
  const auto longest =
      std::ranges::max_element(lengths_m, {}, [](const auto& of_gauge) { return of_gauge.second; });
  return longest == lengths_m.end() ? kStandardGauge_mm : longest->first;
}

}  // namespace railcast
