#include "generator/import/network/tagged_stretches.h"

#include <algorithm>
#include <cmath>

#include "generator/import/lines/line_stretches.h"

namespace railcast {

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
