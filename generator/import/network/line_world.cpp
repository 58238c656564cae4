#include "generator/import/network/line_world.h"

#include <algorithm>
#include <sstream>
#include <utility>

#include "core/base/text.h"
#include "generator/import/lines/contact_lines.h"
#include "generator/import/lines/line_gauge.h"
#include "generator/import/network/track_json.h"
#include "generator/import/structures/structure_json.h"

namespace railcast {
namespace {

using FileJson = nlohmann::ordered_json;

/// Without what would end a field of CSV.
std::string CsvText(std::string_view text) {
  std::string shown = ShownText(text);
  std::ranges::replace(shown, '"', '\'');
  return shown;
}

/// The line as a track.
TrackDraft MainTrack(const RailMap& map, const TrackLine& track, const ImportedLine& line) {
  TrackDraft main = TrackNetwork(line.alignment).tracks().front();
  main.spec.electrified = HasContactLine(map, track);
  return main;
}

/// A list with one item to a line of text.
template <class Item>
std::string ItemsText(const std::vector<Item>& items, const auto& json_of) {
  std::string text = "[";
  const char* separator = "\n    ";
  for (const Item& item : items) {
    text += separator;
    text += json_of(item).dump();
    separator = ",\n    ";
  }
  return text + "\n  ]";
}

}  // namespace

LineWorld MakeLineWorld(const RailMap& map, const TrackLine& track, const ImportedLine& line) {
  LineWorld world;
  world.tracks.push_back({MainTrack(map, track, line), WaysAlong(track, line.chainages_m)});
  const double gauge_mm = line.alignment.gauge_mm;
  const auto has_other_gauge = [&](const MapTags& tags) {
    const std::string_view gauge = TagOf(tags, "gauge");
    return !gauge.empty() && GaugeOf_mm(gauge) != gauge_mm;
  };
  for (const LineStretch& stretch : StretchesWhere(map, world.tracks[0].ways, has_other_gauge)) {
    world.left_out.push_back({"gauge", stretch.begin_s_m, stretch.end_s_m,
                              "the map has " + CsvText(TagOf(map.ways[stretch.way].tags, "gauge")) +
                                  " mm, the world " + NumberText(gauge_mm) + " mm"});
  }
  return world;
}

std::string WorldFileText(const ImportedLine& line, const LineWorld& world, bool has_elevation) {
  std::string text =
      "{\n  \"version\": 1,\n  \"alignment\": " + FileJson(line.name + ".alignment.json").dump() +
      ",\n";
  if (has_elevation) {
    text += "  \"terrain\": " +
            FileJson{{"elevation", {{"file", line.name + ".elevation.asc"}}}}.dump() + ",\n";
  }
  if (!world.structures.empty()) {
    text += "  \"structures\": " +
            ItemsText(world.structures,
                      [](const StructureSpec& structure) { return JsonOf(structure); }) +
            ",\n";
  }
  return text + "  \"tracks\": " +
         ItemsText(world.tracks, [](const WorldTrack& track) { return JsonOf(track.draft.spec); }) +
         "\n}\n";
}

std::string LeftOutCsv(const std::vector<LeftOutLine>& left_out,
                       const std::vector<ImportedLine>& lines,
                       const std::vector<LineWorld>& worlds) {
  std::ostringstream csv;
  csv << "line,what,from_s_m,to_s_m,reason\n";
  const auto add = [&](const std::string& line, const LeftOut& thing) {
    std::string reason = thing.reason;
    std::ranges::replace(reason, '"', '\'');
    csv << line << ',' << thing.what << ',' << RoundedTo(thing.begin_s_m, 100.0) << ','
        << RoundedTo(thing.end_s_m, 100.0) << ",\"" << reason << "\"\n";
  };
  for (const LeftOutLine& line : left_out)
    add(line.name, {"line", 0.0, line.length_m, line.reason});
  for (std::size_t i = 0; i < lines.size(); ++i) {
    for (const LeftOut& thing : worlds[i].left_out) add(lines[i].name, thing);
  }
  return csv.str();
}

std::string MovedCsv(const std::vector<ImportedLine>& lines, const std::vector<LineWorld>& worlds) {
  std::ostringstream csv;
  csv << "line,track,from_s_m,to_s_m,moved_m\n";
  for (std::size_t i = 0; i < lines.size(); ++i) {
    for (const MovedTrack& moved : worlds[i].moved) {
      csv << lines[i].name << ',' << moved.name << ',' << RoundedTo(moved.begin_s_m, 100.0) << ','
          << RoundedTo(moved.end_s_m, 100.0) << ',' << RoundedTo(moved.most_m, 100.0) << '\n';
    }
  }
  return csv.str();
}

}  // namespace railcast
