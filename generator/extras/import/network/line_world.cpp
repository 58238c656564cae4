#include "generator/extras/import/network/line_world.h"

#include <algorithm>
#include <cmath>

#include "core/base/text.h"
#include "generator/extras/import/lines/line_tags.h"
#include "generator/extras/import/lines/speed_limits.h"

namespace railcast {
namespace {

/// The line as a track.
TrackDraft MainTrack(const RailMap& map, const TrackLine& track, const ImportedLine& line) {
  TrackDraft main = TrackNetwork(line.alignment).tracks().front();
  main.spec.electrified = HasContactLine(map, track);
  return main;
}

/// Says where the line's speed is not that of the map.
void TellLineSpeeds(const RailMap& map, const ImportedLine& line, LineWorld& world) {
  for (const LineStretch& way : world.tracks[0].ways) {
    const auto mapped_kmph = SpeedOf_kmph(map.ways[way.way].tags);
    const double speed_kmph =
        SpeedAt_kmph(line.alignment.speed_limits_kmph, 0.5 * (way.begin_s_m + way.end_s_m));
    if (mapped_kmph == speed_kmph) continue;
    const std::string reason =
        mapped_kmph ? "the map has " + NumberText(*mapped_kmph) + " km/h, the world " +
                          NumberText(speed_kmph) + " km/h"
                    : "the map has none, the world " + NumberText(speed_kmph) + " km/h";
    std::vector<LeftOut>& left_out = world.left_out;
    if (!left_out.empty() && left_out.back().what == "speed" && left_out.back().reason == reason &&
        left_out.back().end_s_m >= way.begin_s_m) {
      left_out.back().end_s_m = way.end_s_m;
    } else {
      left_out.push_back({"speed", way.begin_s_m, way.end_s_m, reason});
    }
  }
}

}  // namespace

double WorldTrack::OffAt_m(double s_m) const {
  if (off_m.size() < 2) return off_m.empty() ? 0.0 : off_m.front().y();
  return OffsetOf_m(off_m, std::max(off_m.front().x(), std::min(off_m.back().x(), s_m)));
}

std::vector<MovedTrack> MovedTracksOf(const LineWorld& world) {
  std::vector<MovedTrack> moved;
  for (const WorldTrack& track : world.tracks) {
    const std::vector<Eigen::Vector2d>& off_m = track.off_m;
    bool goes_on = false;
    for (std::size_t i = 0; i < off_m.size(); ++i) {
      const bool is_far = std::abs(off_m[i].y()) > kFarOff_m;
      // Each point stands for what is nearer to it than to others.
      const double begin_s_m = i == 0 ? off_m[i].x() : 0.5 * (off_m[i - 1].x() + off_m[i].x());
      const double end_s_m =
          i + 1 == off_m.size() ? off_m[i].x() : 0.5 * (off_m[i].x() + off_m[i + 1].x());
      if (is_far && !goes_on) moved.push_back({track.draft.spec.name, begin_s_m, end_s_m, 0.0});
      if (is_far) {
        moved.back().end_s_m = end_s_m;
        moved.back().most_m = std::max(moved.back().most_m, std::abs(off_m[i].y()));
      }
      goes_on = is_far;
    }
  }
  return moved;
}

LineWorld MakeLineWorld(const RailMap& map, const TrackLine& track, const ImportedLine& line) {
  LineWorld world;
  world.tracks.push_back({MainTrack(map, track, line), WaysAlong(track, line.chainages_m)});
  for (std::size_t i = 0; i < line.chainages_m.size(); ++i) {
    world.tracks[0].off_m.emplace_back(line.chainages_m[i], line.offsets_m[i]);
  }
  const double gauge_mm = line.alignment.gauge_mm;
  const auto has_other_gauge = [&](const MapTags& tags) {
    const std::string_view gauge = TagOf(tags, "gauge");
    return !gauge.empty() && GaugeOf_mm(gauge) != gauge_mm;
  };
  for (const LineStretch& stretch : StretchesWhere(map, world.tracks[0].ways, has_other_gauge)) {
    world.left_out.push_back({"gauge", stretch.begin_s_m, stretch.end_s_m,
                              "the map has " +
                                  ShownText(TagOf(map.ways[stretch.way].tags, "gauge")) +
                                  " mm, the world " + NumberText(gauge_mm) + " mm"});
  }
  TellLineSpeeds(map, line, world);
  return world;
}

ChainageRange RangeInRun(const LineWorld& world, const WorldTrack& track) {
  constexpr double kSame_m = 2.0;
  const std::vector<Eigen::Vector2d>& points_m = world.beside.runs[track.run].points_m;
  ChainageRange range{track.draft.course.begin_s_m(), track.draft.course.end_s_m()};
  if (track.draft.spec.begin || range.begin_s_m < points_m.front().x() + kSame_m) {
    range.begin_s_m = points_m.front().x();
  }
  if (track.draft.spec.end || range.end_s_m > points_m.back().x() - kSame_m) {
    range.end_s_m = points_m.back().x();
  }
  return range;
}

}  // namespace railcast
