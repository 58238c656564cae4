#include "generator/extras/import/network/track_network.h"

#include <algorithm>
#include <cmath>
#include <utility>
#include <variant>

#include "core/rail/landform/landform.h"
#include "core/rail/line/alignment_course.h"
#include "core/rail/network/network_draft.h"
#include "core/rail/network/world_tracks.h"
#include "generator/extras/import/fit/plan_model.h"

namespace railcast {
namespace {

/// What a world asks for, and a little for the chainages between whole metres.
constexpr double kLeastApart_m = kLeastTrackDistance_m + 0.02;

TrackDraft DraftOf(TrackSpec spec, TrackCourse course) {
  TrackDraft draft{std::move(spec), std::move(course), {}, {}, 0};
  draft.first_m = static_cast<int>(std::ceil(draft.course.begin_s_m()));
  for (int at_m = draft.first_m; at_m <= draft.course.end_s_m(); ++at_m) {
    draft.offsets_m.push_back(draft.course.OffsetAt(at_m).d_m);
  }
  return draft;
}

/// Whether a turnout lies in a track, or the track begins or ends in it.
bool LiesIn(const TurnoutSite& turnout, std::size_t track) {
  return turnout.track == track || turnout.branch == track;
}

bool Overlap(const TurnoutSite& turnout, double one_s_m, double other_s_m) {
  constexpr double kTouching_m = 0.01;
  return std::min(std::max(turnout.s_m, turnout.end_s_m), std::max(one_s_m, other_s_m)) -
             std::max(std::min(turnout.s_m, turnout.end_s_m), std::min(one_s_m, other_s_m)) >=
         kTouching_m;
}

}  // namespace

double TrackDraft::OffsetNear_m(double s_m) const {
  if (offsets_m.empty()) return course.OffsetAt(s_m).d_m;
  const double last = static_cast<double>(offsets_m.size()) - 1.0;
  const double at = std::clamp(s_m - first_m, 0.0, last);
  const auto before = static_cast<std::size_t>(std::floor(at));
  const std::size_t after = std::min(before + 1, offsets_m.size() - 1);
  return std::lerp(offsets_m[before], offsets_m[after], at - std::floor(at));
}

TrackNetwork::TrackNetwork(const AlignmentSpec& line)
    : curvature_(PlanOf({}, std::get<AlignmentElementsSpec>(line.course).elements).Curvature()),
      length_m_(curvature_.end_s_m()),
      ground_(Alignment(line), WorldSpec().terrain.half_width_m) {
  tracks_.push_back(DraftOf({}, TrackCourse(0.0, length_m_, 0.0)));
}

TurnoutPlace TrackNetwork::PlaceOf(const TurnoutSpec& spec, bool opens_ahead) const {
  const auto found = std::ranges::find_if(
      tracks_, [&](const TrackDraft& track) { return track.spec.name == spec.track; });
  return {.pointer = "",
          .spec = spec,
          .track = static_cast<std::size_t>(found - tracks_.begin()),
          .course = found->course,
          .geometry = GeometryOf(spec.turnout),
          .opens_ahead = opens_ahead};
}

bool TrackNetwork::IsFree(std::size_t track, double one_s_m, double other_s_m) const {
  return std::ranges::none_of(tracks_, [&](const TrackDraft& other) {
    return std::ranges::any_of(other.turnouts, [&](const TurnoutSite& turnout) {
      return LiesIn(turnout, track) && Overlap(turnout, one_s_m, other_s_m);
    });
  });
}

std::optional<TrackDraft> TrackNetwork::Make(const TrackSpec& spec) const {
  std::optional<TurnoutPlace> begin;
  std::optional<TurnoutPlace> end;
  if (spec.begin) begin = PlaceOf(*spec.begin, true);
  if (spec.end) end = PlaceOf(*spec.end, false);
  WorldFaults faults;
  std::optional<TrackCourse> course;
  IndependentCourse made;
  if (IsParallel(spec)) {
    course = TrackCourse(spec.start_s_m, spec.end_s_m.value_or(length_m_), *spec.offset_m);
  } else {
    made = MakeIndependentCourse({"", spec, begin, end, length_m_}, faults);
    course = made.course;
  }
  if (!course || !faults.errors.empty() || !(course->begin_s_m() < course->end_s_m())) {
    return std::nullopt;
  }
  TrackDraft draft = DraftOf(spec, *course);
  for (const std::optional<TurnoutSite>& site : {made.begin, made.end}) {
    if (!site) continue;
    if (!IsFree(site->track, site->s_m, site->end_s_m)) return std::nullopt;
    for (const TurnoutSite& other : draft.turnouts) {
      if (Overlap(other, site->s_m, site->end_s_m)) return std::nullopt;
    }
    draft.turnouts.push_back(*site);
    draft.turnouts.back().branch = tracks_.size();
  }
  return draft;
}

std::optional<double> TrackNetwork::FirstConflict_m(const TrackDraft& draft, bool backwards) const {
  std::vector<JoinedSection> joined = joined_;
  for (const TurnoutSite& turnout : draft.turnouts) {
    joined.push_back(JoinedSectionOf(tracks_[turnout.track].course, draft.course, turnout));
  }
  std::optional<double> first_m;
  const int num_metres = draft.end_m() - draft.first_m;
  for (int k = 0; k < num_metres && !first_m; ++k) {
    const int at_m = backwards ? draft.end_m() - 1 - k : draft.first_m + k;
    if (!HasRoom(at_m, draft.course.OffsetAt(at_m))) first_m = at_m;
  }
  for (std::size_t i = 0; i < tracks_.size(); ++i) {
    const TrackDraft& track = tracks_[i];
    const int from_m = std::max(track.first_m, draft.first_m);
    const int to_m = std::min(track.end_m(), draft.end_m());
    for (int k = 0; k < to_m - from_m; ++k) {
      const int at_m = backwards ? to_m - 1 - k : from_m + k;
      if (first_m && (backwards ? at_m <= *first_m : at_m >= *first_m)) break;
      const double apart_m = draft.offsets_m[static_cast<std::size_t>(at_m - draft.first_m)] -
                             track.offsets_m[static_cast<std::size_t>(at_m - track.first_m)];
      if (std::abs(apart_m) >= kLeastApart_m) continue;
      const auto is_joined = [&](double s_m) { return AreJoined(joined, tracks_.size(), i, s_m); };
      if (is_joined(at_m)) continue;
      // Where a turnout's section ends, tracks are as far apart as they must, but not yet more.
      if (std::abs(apart_m) >= kLeastTrackDistance_m &&
          (is_joined(at_m - 1.0) || is_joined(at_m + 1.0))) {
        continue;
      }
      first_m = at_m;
      break;
    }
  }
  if (first_m) return first_m;
  // Sections that turnouts join end between whole metres, and a world is refused there, too.
  for (std::size_t i = 0; i < tracks_.size(); ++i) {
    const auto close =
        FindClosePlace(joined, {{i, tracks_[i].course}, {tracks_.size(), draft.course}});
    if (close) return close->s_m;
  }
  return std::nullopt;
}

std::optional<std::size_t> TrackNetwork::TrackNear(double s_m, double d_m) const {
  std::optional<std::size_t> near;
  double least_m = kApart_m;
  for (std::size_t i = 0; i < tracks_.size(); ++i) {
    const TrackDraft& track = tracks_[i];
    if (!track.Has(s_m) || track.offsets_m.empty()) continue;
    const auto nearest_m =
        std::clamp(static_cast<int>(std::lround(s_m)), track.first_m, track.end_m() - 1);
    const double apart_m =
        std::abs(track.offsets_m[static_cast<std::size_t>(nearest_m - track.first_m)] - d_m);
    if (apart_m >= least_m) continue;
    least_m = apart_m;
    near = i;
  }
  return near;
}

bool TrackNetwork::IsOnGround(double s_m, double d_m) const {
  constexpr double kEdge_m = kFormationEdge_m + 0.5;  // The ground is known every 5 m.
  return ground_.RoomAt_m(s_m, d_m) >= kEdge_m;
}

bool TrackNetwork::HasRoom(double s_m, const TrackOffset& at) const {
  constexpr double kSharpest_per_m = 0.01;
  constexpr double kSharperThanLine = 1.5;
  constexpr double kEver_per_m = 0.9 / kSmallestRadius_m;
  if (!IsOnGround(s_m, at.d_m)) return false;
  const double line_per_m = curvature_.Value(s_m);
  const double most_per_m = std::max(kSharpest_per_m, kSharperThanLine * std::abs(line_per_m));
  return std::abs(CurvatureBeside_per_m(line_per_m, at)) <= std::min(most_per_m, kEver_per_m);
}

void TrackNetwork::Add(TrackDraft draft) {
  for (const TurnoutSite& turnout : draft.turnouts) {
    joined_.push_back(JoinedSectionOf(tracks_[turnout.track].course, draft.course, turnout));
  }
  tracks_.push_back(std::move(draft));
}

}  // namespace railcast
