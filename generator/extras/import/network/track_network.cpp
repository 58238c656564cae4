#include "generator/extras/import/network/track_network.h"

#include <algorithm>
#include <cmath>
#include <utility>
#include <variant>

#include "core/rail/base/world_faults.h"
#include "core/rail/landform/landform.h"
#include "core/rail/line/alignment_course.h"
#include "core/rail/network/network_draft.h"
#include "core/rail/network/world_tracks.h"
#include "generator/extras/import/fit/plan_model.h"

namespace railcast {
namespace {

/// What a world asks for, and a little for the chainages between whole metres.
constexpr double kLeastApart_m = kLeastTrackDistance_m + 0.02;

/// The map has a crossing at most so far from the axes of its tracks.
constexpr double kOnAxis_m = 1.5;
/// Half the length of a crossing: the frogs of one at 1:9 are 13 m from its middle.
constexpr double kHalfDiamond_m = 15.0;

TrackDraft DraftOf(TrackSpec spec, TrackCourse course) {
  TrackDraft draft{std::move(spec), std::move(course), {}, {}, 0, {}};
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

bool LiesIn(const TrackCrossing& crossing, std::size_t track) {
  return crossing.site.first == track || crossing.site.second == track;
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

TrackNetwork::TrackNetwork(const AlignmentSpec& line, std::vector<Eigen::Vector2d> crossings_m)
    : alignment_(line),
      crossings_m_(std::move(crossings_m)),
      curvature_(PlanOf({}, std::get<AlignmentElementsSpec>(line.course).elements).Curvature()),
      length_m_(curvature_.end_s_m()),
      ground_(alignment_, WorldSpec().terrain.half_width_m) {
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
    const auto is_turnout_there = [&](const TurnoutSite& turnout) {
      return LiesIn(turnout, track) && Overlap(turnout, one_s_m, other_s_m);
    };
    const auto is_crossing_there = [&](const TrackCrossing& crossing) {
      return LiesIn(crossing, track) && std::max(one_s_m, other_s_m) > crossing.site.begin_s_m &&
             std::min(one_s_m, other_s_m) < crossing.site.end_s_m;
    };
    return std::ranges::any_of(other.turnouts, is_turnout_there) ||
           std::ranges::any_of(other.crossings, is_crossing_there);
  });
}

double TrackNetwork::InMappedCrossings_m(std::size_t track,
                                         double one_s_m,
                                         double other_s_m) const {
  const auto [from_s_m, to_s_m] = std::minmax(one_s_m, other_s_m);
  double sum_m = 0.0;
  for (const Eigen::Vector2d& place_m : crossings_m_) {
    if (TrackCrossingAt(place_m)) continue;
    if (std::abs(alignment_.At(place_m.x()).cant_rad) > kMostCantAtCrossing_rad) continue;
    if (std::abs(tracks_[track].OffsetNear_m(place_m.x()) - place_m.y()) > kOnAxis_m) continue;
    sum_m += std::max(0.0, std::min(to_s_m, place_m.x() + kHalfDiamond_m) -
                               std::max(from_s_m, place_m.x() - kHalfDiamond_m));
  }
  return sum_m;
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
  AddCrossings(draft);
  return draft;
}

void TrackNetwork::AddCrossings(TrackDraft& draft) const {
  // Tracks that cross at 1:9 and are 0.8 m off do so 7 m farther on.
  constexpr double kAlong_m = 15.0;
  for (std::size_t i = 0; i < tracks_.size(); ++i) {
    const TrackDraft& track = tracks_[i];
    const int to_m = std::min(track.end_m(), draft.end_m());
    double before_m = 0.0;
    for (int at_m = std::max(track.first_m, draft.first_m); at_m < to_m; ++at_m) {
      const double apart_m = draft.offsets_m[static_cast<std::size_t>(at_m - draft.first_m)] -
                             track.offsets_m[static_cast<std::size_t>(at_m - track.first_m)];
      if (apart_m * std::exchange(before_m, apart_m) >= 0.0) continue;
      const auto place_m = std::ranges::find_if(crossings_m_, [&](const Eigen::Vector2d& it) {
        return std::abs(it.x() - at_m) < kAlong_m &&
               std::abs(it.y() - draft.OffsetNear_m(at_m)) < kOnAxis_m;
      });
      if (place_m == crossings_m_.end()) continue;
      if (auto crossing = CrossingAt(*place_m, i, draft, at_m)) {
        draft.crossings.push_back(*crossing);
      }
    }
  }
}

std::optional<TrackCrossing> TrackNetwork::CrossingAt(const Eigen::Vector2d& place_m,
                                                      std::size_t track,
                                                      const TrackDraft& draft,
                                                      double s_m) const {
  // A network of the two tracks, and of a third one that stands for all others.
  const auto in_pair = [&](std::size_t index) -> std::size_t {
    return index == track ? 0 : index == tracks_.size() ? 1 : 2;
  };
  WorldSpec pair;
  pair.tracks = {{.name = "0"}, {.name = "1"}, {.name = "2"}};
  pair.diamond_crossings = {{.tracks = {"0", "1"}, .s_m = s_m}};
  NetworkDraft network{{tracks_[track].course, draft.course, std::nullopt}, {}, {}};
  const auto add = [&](const TrackDraft& other) {
    for (TurnoutSite turnout : other.turnouts) {
      turnout.track = in_pair(turnout.track);
      turnout.branch = in_pair(turnout.branch);
      network.turnouts.push_back(turnout);
    }
    for (const TrackCrossing& crossing : other.crossings) {
      DiamondSite site = crossing.site;
      site.first = in_pair(site.first);
      site.second = in_pair(site.second);
      network.diamonds.push_back(site);
    }
  };
  std::ranges::for_each(tracks_, add);
  add(draft);
  WorldFaults faults;
  const std::size_t num_others = network.diamonds.size();
  FindDiamonds(pair, network, faults);
  if (network.diamonds.size() == num_others) return std::nullopt;
  DiamondSite site = network.diamonds.back();
  CheckNetwork(pair, {network.courses, {}, {site}}, alignment_, faults);
  if (!faults.errors.empty()) return std::nullopt;
  const ChainageRange close = CloseTo(site, network, kLeastTrackDistance_m);
  const auto in_all = [&](std::size_t index) { return index == 0 ? track : tracks_.size(); };
  site.first = in_all(site.first);
  site.second = in_all(site.second);
  return TrackCrossing{site, {site.first, site.second, close.begin_s_m, close.end_s_m}, place_m};
}

std::optional<double> TrackNetwork::FirstConflict_m(const TrackDraft& draft, bool backwards) const {
  std::vector<JoinedSection> joined = joined_;
  for (const TrackCrossing& crossing : draft.crossings) joined.push_back(crossing.close);
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

std::optional<std::string> TrackNetwork::TrackCrossingAt(const Eigen::Vector2d& place_m) const {
  for (const TrackDraft& track : tracks_) {
    for (const TrackCrossing& crossing : track.crossings) {
      if (crossing.place_m == place_m) return track.spec.name;
    }
  }
  return std::nullopt;
}

std::string TrackNetwork::ReasonAgainstCrossing(const Eigen::Vector2d& place_m) const {
  const double s_m = place_m.x();
  if (std::abs(alignment_.At(s_m).cant_rad) > kMostCantAtCrossing_rad) {
    return "the line has cant there, and tracks cross where it has none";
  }
  const auto track = TrackNear(s_m, place_m.y());
  if (track && !IsFree(*track, s_m - kHalfDiamond_m, s_m + kHalfDiamond_m)) {
    return "a turnout lies in the crossing there, and there are no slips";
  }
  return "one of the tracks that cross there is not made";
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
  for (const TrackCrossing& crossing : draft.crossings) joined_.push_back(crossing.close);
  tracks_.push_back(std::move(draft));
}

}  // namespace railcast
