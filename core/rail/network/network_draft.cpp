#include "core/rail/network/network_draft.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <string>
#include <utility>
#include <vector>

#include "core/base/error.h"
#include "core/base/text.h"
#include "core/rail/line/track_course.h"
#include "core/rail/network/turnout_place.h"

namespace railcast {
namespace {

constexpr double kReturn_m = 60.0;
constexpr double kShortestReturn_m = 30.0;

/// Distance of the axes at which both tracks have sleepers of their own (kBearerSpread_m), and that
/// at which the rails behind the frog's nose are whole again (kNoseSpread_m).
constexpr double kOwnSleepers_m = 2.7;
constexpr double kOwnRails_m = 1.7;

/// The first chainage, from one end of a course towards the other one, at which it is so far from
/// the track in which it begins or ends.
double WhereApart_m(const TrackCourse& course,
                    const TrackCourse& track,
                    bool from_end,
                    double apart_m) {
  constexpr double kStep_m = 0.5;
  constexpr double kFarthest_m = 1000.0;  // More than any turnout needs.
  const double length_m = std::min(kFarthest_m, course.end_s_m() - course.begin_s_m());
  const auto chainage_m = [&](double along_m) {
    return from_end ? course.end_s_m() - along_m : course.begin_s_m() + along_m;
  };
  double along_m = 0.0;
  while (along_m < length_m) {
    const double s_m = chainage_m(along_m);
    if (std::abs(course.OffsetAt(s_m).d_m - track.OffsetAt(s_m).d_m) >= apart_m) break;
    along_m += kStep_m;
  }
  return chainage_m(std::min(along_m, length_m));
}

std::vector<SharedPlane> PlanesBetween(const TrackCourse& course,
                                       const TrackCourse& begin,
                                       const TrackCourse& end) {
  double from_s_m = WhereApart_m(course, begin, false, kOwnSleepers_m);
  double to_s_m = WhereApart_m(course, end, true, kOwnSleepers_m);
  if (to_s_m - from_s_m < kShortestReturn_m) {
    from_s_m = WhereApart_m(course, begin, false, kOwnRails_m);
    to_s_m = WhereApart_m(course, end, true, kOwnRails_m);
  }
  // Only tracks too close to be permitted leave less.
  constexpr double kLeast_m = 1.0;
  if (to_s_m - from_s_m < kLeast_m) {
    const double middle_s_m = std::midpoint(from_s_m, to_s_m);
    from_s_m = middle_s_m - 0.5 * kLeast_m;
    to_s_m = middle_s_m + 0.5 * kLeast_m;
  }
  const bool has_room = to_s_m - from_s_m >= 2.0 * kReturn_m;
  return {{begin, from_s_m, has_room ? from_s_m + kReturn_m : to_s_m},
          {end, to_s_m, has_room ? to_s_m - kReturn_m : from_s_m}};
}

/// The course of a track that begins or ends in turnouts, with its height: over a turnout, until
/// the tracks have sleepers of their own, it lies in the canted plane of the track in which the
/// turnout lies. From there it returns to the height of the alignment within 60 m, or, where two
/// turnouts leave no room for that, passes from one plane to the other. Where even the turnouts'
/// bearers touch, it begins to do so behind the frogs.
/// @param begin The track in which it begins; null if it begins in none.
/// @param end As above, where it ends.
TrackCourse InPlanesOfTurnouts(const TrackCourse& course,
                               const TrackCourse* begin,
                               const TrackCourse* end) {
  if (begin != nullptr && end != nullptr) {
    return course.InPlanes(PlanesBetween(course, *begin, *end));
  }
  if (begin != nullptr) {
    const double from_s_m = WhereApart_m(course, *begin, false, kOwnSleepers_m);
    return course.InPlanes({{*begin, from_s_m, from_s_m + kReturn_m}});
  }
  if (end != nullptr) {
    const double to_s_m = WhereApart_m(course, *end, true, kOwnSleepers_m);
    return course.InPlanes({{*end, to_s_m, to_s_m - kReturn_m}});
  }
  return course;
}

/// Makes the courses of a network, those of the tracks in which a track's turnouts lie before that
/// of the track itself.
class NetworkMaker {
 public:
  NetworkMaker(const WorldSpec& world, double length_m, WorldFaults& faults)
      : world_(world), length_m_(length_m), faults_(faults), states_(world.tracks.size()) {
    draft_.courses.resize(world.tracks.size());
  }

  NetworkDraft Make() && {
    for (std::size_t i = 0; i < world_.tracks.size(); ++i) Visit(i);
    return std::move(draft_);
  }

 private:
  enum class State { kUntouched, kInWork, kDone };

  void Visit(std::size_t index) {
    if (states_[index] != State::kUntouched) return;
    states_[index] = State::kInWork;
    const TrackSpec& track = world_.tracks[index];
    if (IsParallel(track)) {
      draft_.courses[index] = ParallelCourse(index);
    } else if (faults_.AreKnown({TrackPointer(index)})) {
      draft_.courses[index] = BranchedCourse(index);
    }
    states_[index] = State::kDone;
  }

  [[nodiscard]] std::optional<TrackCourse> ParallelCourse(std::size_t index) const {
    const TrackSpec& track = world_.tracks[index];
    const std::string place = TrackPointer(index);
    if (!faults_.AreKnown({place + "/offset_m", place + "/start_s_m", place + "/end_s_m"})) {
      return std::nullopt;
    }
    const double end_s_m = track.end_s_m.value_or(length_m_);
    if (!(track.start_s_m < end_s_m)) return std::nullopt;
    return TrackCourse(track.start_s_m, end_s_m, track.offset_m.value_or(0.0));
  }

  /// The place of the turnout in `spec`, on a track that has a course.
  [[nodiscard]] std::optional<TurnoutPlace> PlaceOfTurnout(std::size_t index,
                                                           const TurnoutSpec& spec,
                                                           bool opens_ahead) {
    const std::string pointer = TrackPointer(index) + (opens_ahead ? "/begin" : "/end");
    const std::optional<std::size_t> track = TrackIndex(world_, spec.track);
    if (!track) {
      AddUnknownTrack(world_, pointer + "/track", spec.track, faults_);
      return std::nullopt;
    }
    Visit(*track);
    if (*track == index || states_[*track] == State::kInWork) {
      faults_.Add(pointer + "/track",
                  *track == index ? "must be another track"
                                  : "must not be a track that itself begins or ends on this one",
                  Quoted(spec.track));
      return std::nullopt;
    }
    if (!draft_.courses[*track]) return std::nullopt;
    return TurnoutPlace{.pointer = pointer,
                        .spec = spec,
                        .track = *track,
                        .course = *draft_.courses[*track],
                        .geometry = GeometryOf(spec.turnout),
                        .opens_ahead = opens_ahead};
  }

  [[nodiscard]] std::optional<TrackCourse> BranchedCourse(std::size_t index) {
    const TrackSpec& track = world_.tracks[index];
    std::optional<TurnoutPlace> begin;
    std::optional<TurnoutPlace> end;
    if (track.begin) begin = PlaceOfTurnout(index, *track.begin, true);
    if (track.end) end = PlaceOfTurnout(index, *track.end, false);
    if (track.begin.has_value() != begin.has_value() || track.end.has_value() != end.has_value()) {
      return std::nullopt;
    }
    IndependentCourse made =
        MakeIndependentCourse({TrackPointer(index), track, begin, end, length_m_}, faults_);
    for (const std::optional<TurnoutSite>& turnout : {made.begin, made.end}) {
      if (!made.course || !turnout) continue;
      TurnoutSite site = *turnout;
      site.branch = index;
      draft_.turnouts.push_back(site);
    }
    if (!made.course) return std::nullopt;
    return InPlanesOfTurnouts(*made.course, begin ? &begin->course : nullptr,
                              end ? &end->course : nullptr);
  }

  const WorldSpec& world_;
  double length_m_;
  WorldFaults& faults_;
  std::vector<State> states_;
  NetworkDraft draft_;
};

/// A stretch of a track that a turnout occupies.
struct Occupied {
  const TurnoutSite* turnout{};
  double begin_s_m{};
  double end_s_m{};
};

std::vector<Occupied> StretchesOf(const NetworkDraft& draft, std::size_t track) {
  std::vector<Occupied> stretches;
  for (const TurnoutSite& turnout : draft.turnouts) {
    if (turnout.track != track && turnout.branch != track) continue;
    stretches.push_back(
        {&turnout, std::min(turnout.s_m, turnout.end_s_m), std::max(turnout.s_m, turnout.end_s_m)});
  }
  return stretches;
}

void CheckOverlaps(const WorldSpec& world, const NetworkDraft& draft, WorldFaults& faults) {
  constexpr double kTouching_m = 0.01;
  for (std::size_t track = 0; track < world.tracks.size(); ++track) {
    const std::vector<Occupied> stretches = StretchesOf(draft, track);
    for (std::size_t i = 0; i < stretches.size(); ++i) {
      for (std::size_t k = 0; k < i; ++k) {
        const Occupied& one = stretches[k];
        const Occupied& other = stretches[i];
        if (std::min(one.end_s_m, other.end_s_m) - std::max(one.begin_s_m, other.begin_s_m) <
            kTouching_m) {
          continue;
        }
        faults.Add(TrackPointer(other.turnout->branch) +
                       (other.turnout->opens_ahead() ? "/begin" : "/end"),
                   "must not overlap the turnout of track " +
                       Quoted(world.tracks[one.turnout->branch].name) + " on track " +
                       Quoted(world.tracks[track].name) + ", " +
                       StretchText(one.begin_s_m, one.end_s_m),
                   StretchText(other.begin_s_m, other.end_s_m));
      }
    }
  }
}

}  // namespace

NetworkDraft DraftNetwork(const WorldSpec& world, double length_m, WorldFaults& faults) {
  NetworkDraft draft = NetworkMaker(world, length_m, faults).Make();
  CheckOverlaps(world, draft, faults);
  for (TurnoutSite& turnout : draft.turnouts) {
    turnout.fouling_s_m = ClearChainage_m(
        *draft.courses[turnout.track], *draft.courses[turnout.branch], turnout, kFoulingDistance_m);
  }
  FindDiamonds(world, draft, faults);
  return draft;
}

Network MakeNetwork(const WorldSpec& world, double length_m) {
  WorldFaults faults;
  NetworkDraft draft = DraftNetwork(world, length_m, faults);
  faults.errors.ThrowIfAny();
  return Completed(std::move(draft));
}

Network Completed(NetworkDraft draft) {
  Network network{
      .courses = {}, .turnouts = std::move(draft.turnouts), .diamonds = std::move(draft.diamonds)};
  for (std::optional<TrackCourse>& course : draft.courses) {
    Check(course.has_value(), "a network without faults has all its courses");
    network.courses.push_back(std::move(*course));
  }
  return network;
}

}  // namespace railcast
