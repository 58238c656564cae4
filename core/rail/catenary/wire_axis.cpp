#include "core/rail/catenary/wire_axis.h"

#include <algorithm>
#include <limits>
#include <optional>

#include "core/rail/network/network.h"

namespace railcast {
namespace {

/// The track in which a turnout lies.
std::optional<std::size_t> TrackOfTurnout(const WorldSpec& world,
                                          const std::optional<TurnoutSpec>& turnout) {
  return turnout ? TrackIndex(world, turnout->track) : std::nullopt;
}

}  // namespace

WireAxis::WireAxis(const WorldTracks& tracks, std::size_t track) {
  const std::vector<TrackSpec>& specs = tracks.world.tracks;
  for (std::optional<std::size_t> at = track; at;
       at = TrackOfTurnout(tracks.world, specs[*at].begin)) {
    const double end_s_m =
        sections_.empty() ? tracks.courses[*at].end_s_m() : sections_.back().course->begin_s_m();
    sections_.push_back({&tracks.courses[*at], end_s_m});
  }
  std::ranges::reverse(sections_);
  for (auto at = TrackOfTurnout(tracks.world, specs[track].end); at;
       at = TrackOfTurnout(tracks.world, specs[*at].end)) {
    sections_.push_back({&tracks.courses[*at], tracks.courses[*at].end_s_m()});
  }
  sections_.back().end_s_m = std::numeric_limits<double>::infinity();
}

const TrackCourse& WireAxis::CourseAt(double s_m) const {
  return *std::ranges::find_if(sections_, [&](const Section& section) {
            return s_m <= section.end_s_m;
          })->course;
}

double WireAxis::OffsetAt_m(double s_m) const {
  return CourseAt(s_m).OffsetWithin_m(s_m);
}

double WireAxis::LiftAt_m(const Alignment& alignment, double s_m) const {
  const TrackCourse& course = CourseAt(s_m);
  return course.LiftAt(alignment, std::clamp(s_m, course.begin_s_m(), course.end_s_m())).h_m;
}

}  // namespace railcast
