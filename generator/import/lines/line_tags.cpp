#include "generator/import/lines/line_tags.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cstddef>
#include <map>
#include <string>
#include <string_view>

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

constexpr const char* kUsualKey = "import:usual";

/// Whether a value of `electrified` is a contact line.
bool IsContactLine(std::string_view electrified) {
  return electrified == "contact_line" || electrified == "yes";
}

/// How much of a map's tracks of one kind has what.
struct TaggedLength {
  double all_m{};
  double tagged_m{};
  double contact_line_m{};

  [[nodiscard]] bool UsuallyHasContactLine() const {
    return tagged_m > 0.0 && 2.0 * tagged_m >= all_m && 2.0 * contact_line_m >= tagged_m;
  }
};

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

void FillElectrified(RailMap& map) {
  std::map<std::string, TaggedLength, std::less<>> kinds;
  for (const MapWay& way : map.ways) {
    TaggedLength& kind = kinds[std::string(TagOf(way.tags, "railway"))];
    const double length_m = LengthOf_m(map, way);
    const std::string_view electrified = TagOf(way.tags, "electrified");
    kind.all_m += length_m;
    if (!electrified.empty()) kind.tagged_m += length_m;
    if (IsContactLine(electrified)) kind.contact_line_m += length_m;
  }
  for (MapWay& way : map.ways) {
    if (!TagOf(way.tags, "electrified").empty()) continue;
    const std::string_view kind = TagOf(way.tags, "railway");
    const bool has_one = kind == "tram" || kinds.find(kind)->second.UsuallyHasContactLine();
    way.tags["electrified"] = has_one ? "contact_line" : "no";
    way.tags[kUsualKey] = "electrified";
  }
}

bool HasContactLine(const RailMap& map, const TrackLine& track) {
  // Of what the map says, and of what is usual.
  std::array<double, 2> with_m{};
  std::array<double, 2> without_m{};
  for (std::size_t i = 0; i < track.ways.size(); ++i) {
    const MapTags& tags = map.ways[track.ways[i]].tags;
    const std::string_view electrified = TagOf(tags, "electrified");
    const std::size_t source = TagOf(tags, kUsualKey).empty() ? 0 : 1;
    const double length_m = StepLength_m(map, track, i);
    if (IsContactLine(electrified)) with_m[source] += length_m;
    if (electrified == "no" || electrified == "rail") without_m[source] += length_m;
  }
  const bool says_something = with_m[0] + without_m[0] > 0.0;
  const std::size_t source = says_something ? 0 : 1;
  return with_m[source] > 0.0 && with_m[source] >= without_m[source];
}

}  // namespace railcast
