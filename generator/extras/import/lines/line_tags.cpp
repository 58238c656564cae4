#include "generator/extras/import/lines/line_tags.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cstddef>
#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "core/base/text.h"

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

/// Whether `electrified` has a contact line.
bool IsContactLine(std::string_view electrified) {
  return HasOneOf(electrified, {"contact_line", "yes"});
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

constexpr std::string_view kBetweenSpeeds = ";|";

/// One speed with its unit.
std::optional<double> OneSpeed_kmph(std::string_view text) {
  struct Unit {
    std::string_view name;
    double speed_kmph;
  };
  constexpr auto kUnits = std::to_array<Unit>(
      {{"", 1.0}, {"km/h", 1.0}, {"kmh", 1.0}, {"kph", 1.0}, {"mph", 1.609344}, {"knots", 1.852}});
  constexpr double kFastest_kmph = 1000.0;
  text.remove_prefix(std::min(text.find_first_not_of(' '), text.size()));
  double speed = 0.0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), speed);
  if (error != std::errc{}) return std::nullopt;
  const auto words = Words({end, static_cast<std::size_t>(text.data() + text.size() - end)});
  const std::string_view name = words.empty() ? std::string_view() : words.front();
  const auto unit = std::ranges::find(kUnits, name, &Unit::name);
  if (unit == kUnits.end() || words.size() > 1) return std::nullopt;
  speed *= unit->speed_kmph;
  // "inf" and "nan" are numbers, too.
  return speed > 0.0 && speed <= kFastest_kmph ? std::optional(speed) : std::nullopt;
}

constexpr std::string_view kConditional = "maxspeed:conditional";
constexpr auto kDirections =
    std::to_array<std::string_view>({"maxspeed:forward", "maxspeed:backward"});

/// A value of `maxspeed:conditional`: "60 @ (22:00-06:00)".
struct ConditionalSpeed {
  std::string_view text;
  std::optional<double> speed_kmph;
  bool holds_always{};
};

std::vector<ConditionalSpeed> ConditionalSpeedsOf(std::string_view value) {
  std::vector<ConditionalSpeed> speeds;
  std::size_t begin = 0;
  int depth = 0;  // Conditions in brackets may have semicolons, too.
  for (std::size_t i = 0; i <= value.size(); ++i) {
    if (i < value.size()) {
      depth += value[i] == '(' ? 1 : value[i] == ')' ? -1 : 0;
      if (value[i] != ';' || depth > 0) continue;
    }
    const std::string_view text = value.substr(begin, i - begin);
    begin = i + 1;
    const std::size_t at = std::min(text.find('@'), text.size());
    std::string condition(text.substr(std::min(at + 1, text.size())));
    std::erase_if(condition,
                  [](char letter) { return letter == ' ' || letter == '(' || letter == ')'; });
    speeds.push_back({text.substr(std::min(text.find_first_not_of(' '), text.size())),
                      SpeedOf_kmph(text.substr(0, at)), condition.empty() || condition == "24/7"});
  }
  return speeds;
}

/// Says what becomes of a way's speeds by direction and by condition.
void TellOtherSpeeds(const MapWay& way, std::vector<Remark>& remarks) {
  std::string chosen;
  for (const std::string_view key : kDirections) {
    const std::string_view value = TagOf(way.tags, key);
    if (value.empty()) continue;
    const std::string text = std::string(key) + "=" + ShownText(value);
    if (SpeedOf_kmph(value)) {
      chosen += (chosen.empty() ? "" : ", ") + text;
    } else {
      remarks.push_back({RemarkKind::kSpeedsUnread, way.place, 1, text});
    }
  }
  if (!chosen.empty()) remarks.push_back({RemarkKind::kSpeedsChosen, way.place, 1, chosen});
  const std::string_view conditional = TagOf(way.tags, kConditional);
  if (conditional.empty()) return;
  for (const ConditionalSpeed& each : ConditionalSpeedsOf(conditional)) {
    const bool is_taken = each.holds_always && each.speed_kmph;
    remarks.push_back({is_taken ? RemarkKind::kSpeedsChosen : RemarkKind::kTagsUnread, way.place, 1,
                       std::string(kConditional) + "=" + ShownText(each.text)});
  }
}

/// A tag that is read, and those of its values that are understood.
struct KnownTag {
  std::string_view key;
  std::string_view values;  ///< Between blanks; empty: those of `is_known`.
  bool (*is_known)(std::string_view value) = nullptr;
  bool is_whole_list{};  ///< Whether all values of a list are used.
};

constexpr auto kKnownTags = std::to_array<KnownTag>({
    {"railway",
     " rail light_rail narrow_gauge subway tram preserved platform level_crossing crossing "
     "buffer_stop signal milestone derail "},
    {.key = "electrified", .values = " contact_line yes rail no ", .is_whole_list = true},
    {.key = "gauge",
     .values = "",
     .is_known = [](std::string_view value) { return GaugeIn_mm(value).has_value(); },
     .is_whole_list = true},
    {"service", " yard siding spur crossover "},
    {"usage", " main branch industrial military tourism scientific test freight leisure "},
    {"railway:ballastless", " yes no "},
    {"railway:signal:direction", " forward backward both "},
    {"railway:signal:position", " left right overhead bridge in_track "},
    {"crossing:barrier", " no yes full half double_half gate lift_gate "},
    {"covered", " yes no "},
    {"height", "", [](std::string_view value) { return MetresIn(value).has_value(); }},
});

/// Tells values of known tags that are not understood, or are not taken of a list, and leaves the
/// first value of a list that is understood.
void SettleTags(MapTags& tags, const std::string& place, std::vector<Remark>& remarks) {
  for (const KnownTag& known : kKnownTags) {
    const auto tag = tags.find(known.key);
    if (tag == tags.end()) continue;
    const auto tell = [&](std::string_view text) {
      remarks.push_back(
          {RemarkKind::kTagsUnread, place, 1, std::string(known.key) + "=" + ShownText(text)});
    };
    std::string taken;
    for (const std::string_view value : ValuesOf(tag->second)) {
      const bool is_known =
          known.is_known != nullptr
              ? known.is_known(value)
              : known.values.find(" " + std::string(value) + " ") != std::string_view::npos;
      const bool is_taken = is_known && (taken.empty() || known.is_whole_list);
      if (!is_taken) tell(value);
      if (is_taken) taken += (taken.empty() ? "" : ";") + std::string(value);
    }
    if (!taken.empty()) tag->second = taken;
  }
}

}  // namespace

std::optional<double> GaugeOf_mm(std::string_view gauge) {
  std::optional<double> first_mm;
  for (const std::string_view one : ValuesOf(gauge)) {
    const std::optional<double> gauge_mm = GaugeIn_mm(one);
    if (gauge_mm == kStandardGauge_mm) return gauge_mm;
    if (!first_mm) first_mm = gauge_mm;
  }
  return first_mm;
}

bool HasNoContactLine(std::string_view electrified) {
  return HasOneOf(electrified, {"no", "rail"}) && !IsContactLine(electrified);
}

std::optional<double> MetresIn(std::string_view text) {
  double value_m = 0.0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value_m);
  const std::string_view unit(end, static_cast<std::size_t>(text.data() + text.size() - end));
  if (error != std::errc{} || !(unit.empty() || unit == " m" || unit == "m")) return std::nullopt;
  return value_m;
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
  // Lengths first by what the map says, then by what is usual where it says nothing.
  std::array<double, 2> with_m{};
  std::array<double, 2> without_m{};
  for (std::size_t i = 0; i < track.ways.size(); ++i) {
    const MapTags& tags = map.ways[track.ways[i]].tags;
    const std::string_view electrified = TagOf(tags, "electrified");
    const std::size_t source = TagOf(tags, kUsualKey).empty() ? 0 : 1;
    const double length_m = StepLength_m(map, track, i);
    if (IsContactLine(electrified)) with_m[source] += length_m;
    if (HasNoContactLine(electrified)) without_m[source] += length_m;
  }
  const bool says_something = with_m[0] + without_m[0] > 0.0;
  const std::size_t source = says_something ? 0 : 1;
  return with_m[source] > 0.0 && with_m[source] >= without_m[source];
}

std::optional<double> SpeedOf_kmph(std::string_view maxspeed) {
  std::optional<double> least_kmph;
  while (true) {
    const std::size_t end = std::min(maxspeed.find_first_of(kBetweenSpeeds), maxspeed.size());
    const std::optional<double> one_kmph = OneSpeed_kmph(maxspeed.substr(0, end));
    if (!one_kmph) return std::nullopt;
    least_kmph = std::min(*one_kmph, least_kmph.value_or(*one_kmph));
    if (end == maxspeed.size()) return least_kmph;
    maxspeed.remove_prefix(end + 1);
  }
}

std::optional<double> SpeedOf_kmph(const MapTags& tags) {
  std::optional<double> of_both_kmph = SpeedOf_kmph(TagOf(tags, "maxspeed"));
  const std::string_view conditional = TagOf(tags, kConditional);
  if (!conditional.empty()) {
    for (const ConditionalSpeed& each : ConditionalSpeedsOf(conditional)) {
      if (each.holds_always && each.speed_kmph) of_both_kmph = each.speed_kmph;
    }
  }
  std::optional<double> least_kmph;
  for (const std::string_view key : kDirections) {
    const std::optional<double> own_kmph = SpeedOf_kmph(TagOf(tags, key));
    const std::optional<double> speed_kmph = own_kmph ? own_kmph : of_both_kmph;
    if (speed_kmph) least_kmph = std::min(*speed_kmph, least_kmph.value_or(*speed_kmph));
  }
  return least_kmph;
}

void TellTags(RailMap& map) {
  for (MapWay& way : map.ways) SettleTags(way.tags, way.place, map.remarks);
  for (MapThing& thing : map.things) {
    const Eigen::Vector2d& place_deg = thing.geographic_deg.front();
    SettleTags(thing.tags,
               "thing at " + NumberText(place_deg.y()) + ", " + NumberText(place_deg.x()),
               map.remarks);
  }
  constexpr auto kOthers = std::to_array<std::string_view>(
      {"maxspeed:type", "maxspeed:source", "maxspeed:reason", "maxspeed:note", kDirections[0],
       kDirections[1], kConditional});
  for (const MapWay& way : map.ways) {
    const std::string_view maxspeed = TagOf(way.tags, "maxspeed");
    if (!maxspeed.empty() && !SpeedOf_kmph(maxspeed)) {
      map.remarks.push_back({RemarkKind::kSpeedsUnread, way.place, 1, Quoted(maxspeed)});
    } else if (maxspeed.find_first_of(kBetweenSpeeds) != std::string_view::npos) {
      map.remarks.push_back({RemarkKind::kSpeedsChosen, way.place, 1, Quoted(maxspeed)});
    }
    TellOtherSpeeds(way, map.remarks);
    for (const auto& [key, value] : way.tags) {
      const bool is_speed =
          key.starts_with("maxspeed:") && std::ranges::find(kOthers, key) == kOthers.end();
      const bool is_several = key == "tracks" && value != "1";
      if (!is_speed && !is_several) continue;
      map.remarks.push_back(
          {RemarkKind::kTagsUnread, way.place, 1, ShownText(key) + "=" + ShownText(value)});
    }
  }
}

}  // namespace railcast
