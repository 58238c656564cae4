#include "generator/import/network/line_world.h"

#include <algorithm>
#include <sstream>
#include <utility>

#include "core/base/text.h"
#include "core/scenario/describe_world.h"
#include "core/scenario/json_writer.h"
#include "generator/import/lines/contact_lines.h"
#include "generator/import/lines/line_files.h"
#include "generator/import/lines/line_gauge.h"

namespace railcast {
namespace {

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

Json JsonOf(TrackSpec track) {
  Json json = {{"name", track.name}};  // A list reads better with names, also with the usual one.
  json.update(JsonWriter::WriteShort(track));
  return json;
}

Json JsonOf(StructureSpec structure) {
  return JsonWriter::WriteShort(structure);
}

std::string WorldFileText(const ImportedLine& line, const LineWorld& world, bool has_elevation) {
  Json file = {{"version", 1}, {"alignment", line.name + ".alignment.json"}};
  if (has_elevation) file["terrain"]["elevation"]["file"] = line.name + ".elevation.asc";
  for (const StructureSpec& spec : world.structures) file["structures"].push_back(JsonOf(spec));
  for (const WorldTrack& track : world.tracks) file["tracks"].push_back(JsonOf(track.draft.spec));
  return TextWithItems(file) + "\n";
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
