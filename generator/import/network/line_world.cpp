#include "generator/import/network/line_world.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "core/base/text.h"
#include "generator/import/lines/line_tags.h"

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

bool IsTunnel(const MapTags& tags) {
  return IsThere(TagOf(tags, "tunnel")) && TagOf(tags, "tunnel") != "building_passage";
}

bool IsBridge(const MapTags& tags) {
  return IsThere(TagOf(tags, "bridge")) && !IsTunnel(tags);
}

std::vector<TaggedStretch> StretchesOfAll(const RailMap& map,
                                          const LineWorld& world,
                                          const std::function<bool(const MapTags&)>& has) {
  constexpr double kSteps_per_m = 100.0;
  std::vector<TaggedStretch> all;
  for (std::size_t i = 0; i < world.tracks.size(); ++i) {
    const TrackCourse& course = world.tracks[i].draft.course;
    const double first_m = std::ceil(course.begin_s_m() * kSteps_per_m) / kSteps_per_m;
    const double last_m = std::floor(course.end_s_m() * kSteps_per_m) / kSteps_per_m;
    for (const LineStretch& stretch : StretchesWhere(map, world.tracks[i].ways, has)) {
      const auto on_track_m = [&](double s_m) {
        return std::clamp(std::round(s_m * kSteps_per_m) / kSteps_per_m, first_m,
                          std::max(first_m, last_m));
      };
      const TaggedStretch on_track{i, on_track_m(stretch.begin_s_m), on_track_m(stretch.end_s_m)};
      if (on_track.length_m() > 0.0) all.push_back(on_track);
    }
  }
  return all;
}

}  // namespace railcast
