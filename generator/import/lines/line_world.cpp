#include "generator/import/lines/line_world.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <limits>
#include <optional>
#include <sstream>

#include "core/base/text.h"
#include "generator/import/lines/line_gauge.h"
#include "generator/import/lines/line_places.h"
#include "generator/import/lines/line_stretches.h"

namespace railcast {
namespace {

double Centimetres(double value_m) {
  return RoundedTo(value_m, 100.0);
}

/// Numbers things of a kind: platform_1, platform_2.
std::string NameOfNext(const std::vector<WorldJson>& structures, const std::string& type) {
  const auto num_before = std::ranges::count_if(
      structures, [&](const WorldJson& other) { return other["type"] == type; });
  return type + "_" + std::to_string(num_before + 1);
}

void AddStructure(const std::string& type, const WorldJson& keys, LineWorld& world) {
  WorldJson structure = {{"type", type}, {"name", NameOfNext(world.structures, type)}};
  structure.update(keys);
  world.structures.push_back(std::move(structure));
}

/// Without what would end a field of CSV.
std::string TextOfGauge(std::string_view gauge) {
  std::string text = ShownText(gauge);
  std::ranges::replace(text, '"', '\'');
  return text;
}

void AddStretches(const RailMap& map,
                  const TrackLine& track,
                  const ImportedLine& line,
                  LineWorld& world) {
  const auto add = [&](const std::string& type, const auto& has, const WorldJson& keys) {
    for (const LineStretch& stretch : StretchesWhere(map, track, line.chainages_m, has)) {
      WorldJson all = {{"begin_s_m", Centimetres(stretch.begin_s_m)},
                       {"end_s_m", Centimetres(stretch.end_s_m)}};
      all.update(keys);
      AddStructure(type, all, world);
    }
  };
  const auto is_tunnel = [](const MapTags& tags) {
    return IsThere(TagOf(tags, "tunnel")) && TagOf(tags, "tunnel") != "building_passage";
  };
  add("tunnel", is_tunnel, WorldJson::object());
  add(
      "bridge",
      [&](const MapTags& tags) { return IsThere(TagOf(tags, "bridge")) && !is_tunnel(tags); },
      WorldJson::object());
  add(
      "slab_track", [](const MapTags& tags) { return TagOf(tags, "railway:ballastless") == "yes"; },
      WorldJson::object());
  // Its side is not mapped.
  add("third_rail", [](const MapTags& tags) { return TagOf(tags, "electrified") == "rail"; },
      {{"side", "right"}});
  const double gauge_mm = line.alignment.gauge_mm;
  const auto has_other_gauge = [&](const MapTags& tags) {
    const std::string_view gauge = TagOf(tags, "gauge");
    return !gauge.empty() && GaugeOf_mm(gauge) != gauge_mm;
  };
  for (const LineStretch& stretch : StretchesWhere(map, track, line.chainages_m, has_other_gauge)) {
    world.left_out.push_back({"gauge", stretch.begin_s_m,
                              "the map has " +
                                  TextOfGauge(TagOf(map.ways[stretch.way].tags, "gauge")) +
                                  " mm, the world " + NumberText(gauge_mm) + " mm"});
  }
}

/// The main track, and whether most of it has a contact line.
WorldJson MainTrack(const RailMap& map, const TrackLine& track) {
  double with_m = 0.0;
  double without_m = 0.0;
  for (std::size_t i = 0; i < track.ways.size(); ++i) {
    const std::string_view electrified = TagOf(map.ways[track.ways[i]].tags, "electrified");
    const double length_m = StepLength_m(map, track, i);
    if (electrified == "contact_line" || electrified == "yes") with_m += length_m;
    if (electrified == "no" || electrified == "rail") without_m += length_m;
  }
  return {{"name", "main"}, {"electrified", with_m >= without_m}};
}

/// A number of metres in a tag; absent for anything else.
std::optional<double> MetresIn(std::string_view text) {
  double value_m = 0.0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value_m);
  const std::string_view unit(end, static_cast<std::size_t>(text.data() + text.size() - end));
  if (error != std::errc{} || !(unit.empty() || unit == " m" || unit == "m")) return std::nullopt;
  return value_m;
}

void AddPlatform(const MapThing& thing, const LinePlaces& places, LineWorld& world) {
  constexpr double kFarthest_m = 4.5;
  constexpr double kNearest_m = 1.0;
  constexpr double kReach_m = 30.0;
  constexpr double kShortest_m = 5.0;
  double begin_s_m = std::numeric_limits<double>::infinity();
  double end_s_m = 0.0;
  double least_m = std::numeric_limits<double>::infinity();
  double most_m = 0.0;
  double sum_m = 0.0;
  for (const Eigen::Vector2d& place_m : thing.places_m) {
    const std::optional<LinePlace> at = places.Of(place_m, kReach_m);
    if (!at) return;
    begin_s_m = std::min(begin_s_m, at->s_m);
    end_s_m = std::max(end_s_m, at->s_m);
    least_m = std::min(least_m, std::abs(at->d_m));
    most_m = std::max(most_m, std::abs(at->d_m));
    sum_m += at->d_m;
  }
  if (thing.places_m.size() < 2 || end_s_m - begin_s_m < kShortest_m || least_m > kFarthest_m) {
    return;
  }
  if (least_m < kNearest_m) {
    world.left_out.push_back({"platform", begin_s_m, "it lies across the track on the map"});
    return;
  }
  WorldJson keys = {{"begin_s_m", Centimetres(begin_s_m)},
                    {"end_s_m", Centimetres(end_s_m)},
                    {"side", sum_m > 0.0 ? "left" : "right"}};
  // Of a line, it is not known how wide it is.
  constexpr double kNarrowest_m = 1.0;
  if (most_m - least_m >= kNarrowest_m) keys["width_m"] = Centimetres(most_m - least_m);
  const std::optional<double> height_m = MetresIn(TagOf(thing.tags, "height"));
  if (height_m && *height_m >= 0.2 && *height_m <= 1.3) keys["height_m"] = *height_m;
  if (TagOf(thing.tags, "covered") == "yes") keys["roof"] = WorldJson::object();
  AddStructure("platform", keys, world);
}

/// Kind and direction of a signal; null if the map does not say what it is.
WorldJson SignalKeys(const MapThing& thing, const LinePlace& at, const LinePlaces& places) {
  const auto has = [&](std::string_view key) { return !TagOf(thing.tags, key).empty(); };
  WorldJson keys;
  if (has("railway:signal:main") || has("railway:signal:combined")) {
    keys["kind"] = "main";
  } else if (has("railway:signal:distant")) {
    keys["kind"] = "distant";
  } else if (has("railway:signal:shunting") || has("railway:signal:minor")) {
    keys["kind"] = "shunting";
  } else {
    return {};
  }
  const bool is_backward = TagOf(thing.tags, "railway:signal:direction") == "backward";
  const bool is_rising = places.IsForward(at.node) != is_backward;
  keys["direction"] = is_rising ? "rising" : "falling";
  if (TagOf(thing.tags, "railway:signal:position") == "left") {
    keys["side"] = is_rising ? "left" : "right";
  }
  return keys;
}

void AddPoint(const MapThing& thing, const LinePlaces& places, LineWorld& world) {
  constexpr double kOnLine_m = 2.0;
  constexpr double kNearEnd_m = 20.0;
  const std::optional<LinePlace> at = places.Of(thing.places_m.front(), kOnLine_m);
  if (!at) return;
  const std::string_view railway = TagOf(thing.tags, "railway");
  const double s_m = Centimetres(at->s_m);
  if (railway == "buffer_stop") {
    const bool is_begin = at->s_m < kNearEnd_m;
    if (is_begin || at->s_m > places.length_m() - kNearEnd_m) {
      AddStructure("buffer_stop", {{"at", is_begin ? "begin" : "end"}}, world);
    } else {
      world.left_out.push_back({"buffer_stop", s_m, "the line goes on behind it"});
    }
    return;
  }
  if (std::abs(at->beyond_m) > kOnLine_m) return;
  if (railway == "level_crossing" || railway == "crossing") {
    WorldJson keys = {{"s_m", s_m}};
    if (railway == "crossing") {
      keys["road_width_m"] = 2.0;
      keys["barriers"] = "none";
    } else if (TagOf(thing.tags, "crossing:barrier") == "no") {
      keys["barriers"] = "none";
    }
    AddStructure("level_crossing", keys, world);
  } else if (railway == "milestone") {
    AddStructure("board", {{"s_m", s_m}, {"kind", "kilometre"}}, world);
  } else if (railway == "derail") {
    AddStructure("derailer", {{"s_m", s_m}}, world);
  } else if (railway == "signal") {
    WorldJson keys = {{"s_m", s_m}};
    const WorldJson kind = SignalKeys(thing, *at, places);
    if (kind.is_null()) {
      world.left_out.push_back({"signal", s_m, "the map does not say which kind it is"});
      return;
    }
    keys.update(kind);
    AddStructure("signal", keys, world);
  }
}

/// A list with one item to a line of text.
std::string ItemsText(const std::vector<WorldJson>& items) {
  std::string text = "[";
  const char* separator = "\n    ";
  for (const WorldJson& item : items) {
    text += separator;
    text += item.dump();
    separator = ",\n    ";
  }
  return text + "\n  ]";
}

}  // namespace

LineWorld MakeLineWorld(const RailMap& map, const TrackLine& track, const ImportedLine& line) {
  LineWorld world;
  world.tracks.push_back(MainTrack(map, track));
  AddStretches(map, track, line, world);
  const LinePlaces places(map, track, line);
  for (const MapThing& thing : map.things) {
    if (TagOf(thing.tags, "railway") == "platform") {
      AddPlatform(thing, places, world);
    } else {
      AddPoint(thing, places, world);
    }
  }
  return world;
}

std::string WorldFileText(const ImportedLine& line, const LineWorld& world, bool has_elevation) {
  std::string text =
      "{\n  \"version\": 1,\n  \"alignment\": " + WorldJson(line.name + ".alignment.json").dump() +
      ",\n";
  if (has_elevation) {
    text += "  \"terrain\": " +
            WorldJson{{"elevation", {{"file", line.name + ".elevation.asc"}}}}.dump() + ",\n";
  }
  if (!world.structures.empty()) {
    text += "  \"structures\": " + ItemsText(world.structures) + ",\n";
  }
  return text + "  \"tracks\": " + ItemsText(world.tracks) + "\n}\n";
}

std::string LeftOutCsv(const std::vector<ImportedLine>& lines,
                       const std::vector<LineWorld>& worlds) {
  std::ostringstream csv;
  csv << "line,what,s_m,reason\n";
  for (std::size_t i = 0; i < lines.size(); ++i) {
    for (const LeftOut& thing : worlds[i].left_out) {
      csv << lines[i].name << ',' << thing.what << ',' << Centimetres(thing.s_m) << ",\""
          << thing.reason << "\"\n";
    }
  }
  return csv.str();
}

}  // namespace railcast
