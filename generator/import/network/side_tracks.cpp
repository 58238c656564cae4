#include "generator/import/network/side_tracks.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <variant>

#include "core/rail/chainage_range.h"
#include "core/rail/line/alignment_course.h"
#include "generator/import/lines/line_gauge.h"
#include "generator/import/lines/line_places.h"
#include "generator/import/network/level_tracks.h"
#include "generator/import/network/switch_nodes.h"
#include "generator/import/network/track_network.h"
#include "generator/import/network/track_runs.h"
#include "generator/import/network/turnout_search.h"

namespace railcast {
namespace {

/// Where a run meets another track, and what became of it.
struct MeetingPoint {
  Eigen::Vector2d place_m = Eigen::Vector2d::Zero();
  std::optional<double> turnout_s_m;
};

/// A run that is being made, and the tracks that it meets.
struct OpenRun {
  TrackRun run;
  std::optional<Meeting> begin;
  std::optional<Meeting> end;

  [[nodiscard]] std::size_t num_meetings() const { return (begin ? 1U : 0U) + (end ? 1U : 0U); }
};

/// The part of a run between two chainages of it; absent if it is short.
std::optional<TrackRun> PartOfRun(const TrackRun& run, double from_s_m, double to_s_m) {
  constexpr double kShortest_m = 30.0;
  constexpr double kSame_m = 0.5;
  if (to_s_m - from_s_m < kShortest_m) return std::nullopt;
  TrackRun part = run;
  part.points_m = {{from_s_m, OffsetOf_m(run, from_s_m)}};
  for (const Eigen::Vector2d& point_m : run.points_m) {
    if (point_m.x() > from_s_m + kSame_m && point_m.x() < to_s_m - kSame_m) {
      part.points_m.push_back(point_m);
    }
  }
  part.points_m.emplace_back(to_s_m, OffsetOf_m(run, to_s_m));
  return part;
}

/// A cut is this far from where a track comes too near to others, and sought in these steps.
constexpr double kCutMargin_m = 1.0;
constexpr double kCutStep_m = 0.5;

/// The length of a fit, not above another one, at which it is cut before a chainage.
double EndBefore_m(const RunFit& fit, double most_m, double conflict_s_m) {
  double at_m = most_m;
  while (at_m > 0.0 && fit.course.At(at_m).x_m > conflict_s_m - kCutMargin_m) at_m -= kCutStep_m;
  return fit.OutOfClothoid_m(at_m, true);
}

/// The length of a fit from which on it lies behind a chainage.
double BeginBehind_m(const RunFit& fit, double conflict_s_m) {
  double at_m = 0.0;
  while (at_m < fit.plan.length_m() && fit.course.At(at_m).x_m < conflict_s_m + kCutMargin_m) {
    at_m += kCutStep_m;
  }
  return fit.OutOfClothoid_m(at_m, false);
}

class SideTrackSearch {
 public:
  SideTrackSearch(TrackNetwork network, const ImportedLine& line, double sigma_m, LineWorld& world)
      : network_(std::move(network)),
        has_turnouts_(line.alignment.gauge_mm == kStandardGauge_mm),
        sigma_m_(sigma_m),
        world_(world) {}

  void Take(const TrackRun& run) {
    OpenRun open{run, MeetingAt(run.points_m.front(), true), MeetingAt(run.points_m.back(), false)};
    for (const auto& [meeting, point_m] :
         {std::pair(open.begin, run.points_m.front()), std::pair(open.end, run.points_m.back())}) {
      if (meeting) meetings_.push_back({point_m, std::nullopt});
    }
    std::optional<TrackDraft> level = LevelTrackOf(network_, run, open.begin, open.end);
    if (level && level->turnouts.size() == open.num_meetings()) {
      Accept(run, std::move(*level));
      return;
    }
    const RunFit fit(run, sigma_m_);
    if (open.num_meetings() > 0 && TakeWhole(open, fit)) return;
    if (level && (!level->turnouts.empty() || open.num_meetings() == 0)) {
      Accept(run, std::move(*level));
      return;
    }
    TakeParts(std::move(open), fit, std::move(level));
  }

  /// Says which of the map's switches on the world's tracks are no turnouts.
  void CountSwitches(const std::vector<SwitchNode>& switches);

  [[nodiscard]] SideTrackQuality& quality() { return quality_; }

 private:
  [[nodiscard]] std::optional<Meeting> MeetingAt(const Eigen::Vector2d& point_m,
                                                 bool opens_ahead) const;
  /// Makes a track of the whole run with turnouts wherever it meets others.
  bool TakeWhole(const OpenRun& open, const RunFit& fit);
  void TakeParts(OpenRun open, const RunFit& fit, std::optional<TrackDraft> level);
  /// A track with one turnout that is apart from others, or, if there is none, the chainage
  /// farthest from its turnout at which one comes too near to them.
  struct OneEnded {
    std::optional<TrackDraft> draft;
    std::optional<double> conflict_m;
  };
  /// The first of some tracks that is possible.
  [[nodiscard]] OneEnded BestWithOneEnd(const TrackRun& run,
                                        const std::vector<TrackSpec>& specs) const;
  /// Makes a track from a turnout at one end of the run as far as it is apart from others.
  /// @return Where it ends.
  std::optional<double> TakeFromOneEnd(const OpenRun& open, const RunFit& fit, bool is_begin);
  /// Makes tracks without turnouts of all stretches of a run that are apart from others.
  void TakeFree(const TrackRun& run);
  /// @param stretch Of the fit.
  /// @param made_up_to_s_m Chainage up to which it is known what becomes of the run.
  void TakeStretch(const TrackRun& run,
                   const RunFit& fit,
                   const ChainageRange& stretch,
                   double& made_up_to_s_m);
  void Accept(const TrackRun& run, TrackDraft draft);
  void LeaveOutBetween(const TrackRun& run, double from_s_m, double to_s_m) {
    constexpr double kLeast_m = 2.0;
    if (to_s_m - from_s_m < kLeast_m) return;
    world_.left_out.push_back({run.kind + " track", from_s_m, to_s_m,
                               "it is nearer than 3 m to others there, too sharp, or too short"});
  }

  TrackNetwork network_;
  bool has_turnouts_;  ///< There are none of other gauges.
  double sigma_m_;
  LineWorld& world_;
  std::map<std::string, int> num_of_kind_;
  std::vector<MeetingPoint> meetings_;
  SideTrackQuality quality_;
};

std::optional<Meeting> SideTrackSearch::MeetingAt(const Eigen::Vector2d& point_m,
                                                  bool opens_ahead) const {
  if (!has_turnouts_) return std::nullopt;
  constexpr double kFarthest_m = 1.5;
  std::optional<Meeting> nearest;
  double least_m = kFarthest_m;
  for (std::size_t i = 0; i < network_.tracks().size(); ++i) {
    const TrackDraft& track = network_.tracks()[i];
    if (!track.Has(point_m.x())) continue;
    const double off_m = std::abs(track.course.OffsetAt(point_m.x()).d_m - point_m.y());
    if (off_m >= least_m) continue;
    least_m = off_m;
    nearest = Meeting{i, point_m.x(), opens_ahead};
  }
  return nearest;
}

bool SideTrackSearch::TakeWhole(const OpenRun& open, const RunFit& fit) {
  std::vector<TurnoutChoice> begins;
  std::vector<TurnoutChoice> ends;
  if (open.begin) begins = TurnoutChoices(network_, open.run, fit, *open.begin);
  if (open.end) ends = TurnoutChoices(network_, open.run, fit, *open.end);
  if ((open.begin && begins.empty()) || (open.end && ends.empty())) return false;
  const double free_end_m = open.begin ? fit.plan.length_m() : 0.0;
  for (const TrackSpec& spec :
       TracksBetween(fit, open.begin ? &begins : nullptr, open.end ? &ends : nullptr, free_end_m)) {
    std::optional<TrackDraft> draft = network_.Make(spec);
    if (!draft || !Follows(*draft, open.run) || network_.FirstConflict_m(*draft)) continue;
    Accept(open.run, std::move(*draft));
    return true;
  }
  return false;
}

SideTrackSearch::OneEnded SideTrackSearch::BestWithOneEnd(
    const TrackRun& run, const std::vector<TrackSpec>& specs) const {
  constexpr double kShortest_m = 20.0;
  OneEnded best;
  for (const TrackSpec& spec : specs) {
    best.draft = network_.Make(spec);
    if (!best.draft || !Follows(*best.draft, run)) continue;
    const TurnoutSite& turnout = best.draft->turnouts.front();
    const auto near_m = network_.FirstConflict_m(*best.draft, !turnout.opens_ahead());
    if (!near_m) return best;
    if (std::abs(*near_m - turnout.s_m) < std::abs(turnout.end_s_m - turnout.s_m) + kShortest_m) {
      continue;
    }
    if (!best.conflict_m ||
        std::abs(*near_m - turnout.s_m) > std::abs(*best.conflict_m - turnout.s_m)) {
      best.conflict_m = near_m;
    }
  }
  best.draft.reset();
  return best;
}

std::optional<double> SideTrackSearch::TakeFromOneEnd(const OpenRun& open,
                                                      const RunFit& fit,
                                                      bool is_begin) {
  const std::vector<TurnoutChoice> choices =
      TurnoutChoices(network_, open.run, fit, is_begin ? *open.begin : *open.end);
  double free_end_m = is_begin ? fit.plan.length_m() : 0.0;
  // Cut, where it comes near to others, once for the best choice, and once more for rounding.
  for (int attempt = 0; attempt < 3; ++attempt) {
    OneEnded best =
        BestWithOneEnd(open.run, TracksBetween(fit, is_begin ? &choices : nullptr,
                                               is_begin ? nullptr : &choices, free_end_m));
    if (best.draft) {
      const TrackCourse& course = best.draft->course;
      const double end_s_m = is_begin ? course.end_s_m() : course.begin_s_m();
      Accept(open.run, std::move(*best.draft));
      return end_s_m;
    }
    if (!best.conflict_m) return std::nullopt;
    free_end_m = is_begin ? EndBefore_m(fit, free_end_m, *best.conflict_m)
                          : BeginBehind_m(fit, *best.conflict_m);
  }
  return std::nullopt;
}

void SideTrackSearch::TakeParts(OpenRun open, const RunFit& fit, std::optional<TrackDraft> level) {
  double from_s_m = open.run.points_m.front().x();
  double to_s_m = open.run.points_m.back().x();
  if (open.begin) {
    if (const auto end_s_m = TakeFromOneEnd(open, fit, true)) from_s_m = *end_s_m;
  }
  if (open.end) {
    if (const auto begin_s_m = TakeFromOneEnd(open, fit, false)) to_s_m = *begin_s_m;
  }
  const bool is_untouched =
      from_s_m == open.run.points_m.front().x() && to_s_m == open.run.points_m.back().x();
  if (is_untouched && level) {
    Accept(open.run, std::move(*level));
    return;
  }
  if (is_untouched) {
    TakeFree(open.run);
  } else if (const auto rest = PartOfRun(open.run, from_s_m, to_s_m)) {
    TakeFree(*rest);
  } else {
    LeaveOutBetween(open.run, from_s_m, to_s_m);
  }
}

void SideTrackSearch::TakeFree(const TrackRun& run) {
  const RunFit fit(run, sigma_m_);
  // Stretches that are apart from all others, with ends at whole metres of the fit.
  std::vector<ChainageRange> free;
  bool goes_on = false;
  for (double at_m = 0.0; at_m <= fit.plan.length_m(); ++at_m) {
    const PlanPoint at = fit.course.At(at_m);
    const double slope = std::tan(at.heading_rad);
    const TrackOffset offset{at.y_m, slope,
                             at.curvature_per_m * std::pow(1.0 + slope * slope, 1.5)};
    const bool fits = at.x_m >= 0.0 && at.x_m <= network_.length_m() &&
                      network_.IsApartAt(at.x_m, at.y_m) && network_.HasRoom(at.x_m, offset);
    if (fits && !goes_on) free.push_back({at_m, at_m});
    if (fits) free.back().end_s_m = at_m;
    goes_on = fits;
  }
  double made_up_to_s_m = run.points_m.front().x();
  for (const ChainageRange& stretch : free) TakeStretch(run, fit, stretch, made_up_to_s_m);
  LeaveOutBetween(run, made_up_to_s_m, run.points_m.back().x());
}

void SideTrackSearch::TakeStretch(const TrackRun& run,
                                  const RunFit& fit,
                                  const ChainageRange& stretch,
                                  double& made_up_to_s_m) {
  constexpr double kShortest_m = 30.0;
  const double from_m = fit.OutOfClothoid_m(stretch.begin_s_m, false);
  const double to_m = fit.OutOfClothoid_m(stretch.end_s_m, true);
  if (to_m - from_m < kShortest_m) return;
  std::optional<TrackDraft> draft = network_.Make(TrackOfPart(fit, from_m, to_m));
  if (!draft) return;
  if (const auto conflict_s_m = network_.FirstConflict_m(*draft)) {
    TakeStretch(run, fit, {from_m, EndBefore_m(fit, to_m, *conflict_s_m)}, made_up_to_s_m);
    const double behind_m = BeginBehind_m(fit, *conflict_s_m);
    if (behind_m > from_m) TakeStretch(run, fit, {behind_m, to_m}, made_up_to_s_m);
    return;
  }
  LeaveOutBetween(run, made_up_to_s_m, draft->course.begin_s_m());
  made_up_to_s_m = draft->course.end_s_m();
  Accept(run, std::move(*draft));
}

void SideTrackSearch::Accept(const TrackRun& run, TrackDraft draft) {
  draft.spec.name = run.kind + "_" + std::to_string(++num_of_kind_[run.kind]);
  draft.spec.electrified = run.is_electrified;
  world_.tracks.push_back({draft, run.ways});
  for (const Eigen::Vector2d& point_m : run.points_m) {
    if (!draft.Has(point_m.x())) continue;
    quality_.distances_m.push_back(std::abs(draft.course.OffsetAt(point_m.x()).d_m - point_m.y()));
  }
  for (const TurnoutSite& turnout : draft.turnouts) {
    const Eigen::Vector2d& place_m =
        turnout.opens_ahead() ? run.points_m.front() : run.points_m.back();
    for (MeetingPoint& meeting : meetings_) {
      if (meeting.place_m == place_m) meeting.turnout_s_m = turnout.s_m;
    }
  }
  ++quality_.num_tracks;
  quality_.num_turnouts += draft.turnouts.size();
  quality_.length_m += draft.course.end_s_m() - draft.course.begin_s_m();
  network_.Add(std::move(draft));
}

void SideTrackSearch::CountSwitches(const std::vector<SwitchNode>& switches) {
  quality_.num_on_map = switches.size();
  constexpr double kSame_m = 0.6;  // Nodes nearer than 0.5 m to the one before are left out.
  for (const SwitchNode& node : switches) {
    const auto leave_out = [&](const char* reason) {
      world_.left_out.push_back({"switch", node.place_m.x(), node.place_m.x(), reason});
    };
    if (!MeetingAt(node.place_m, true)) {
      leave_out("it lies on no track of the world");
      continue;
    }
    ++quality_.num_switches;
    const MeetingPoint* met = nullptr;
    for (const MeetingPoint& meeting : meetings_) {
      if ((meeting.place_m - node.place_m).norm() > kSame_m) continue;
      if (!met || !met->turnout_s_m) met = &meeting;
    }
    if (met && met->turnout_s_m) {
      ++quality_.num_made;
      quality_.shifts_m.push_back(std::abs(*met->turnout_s_m - node.place_m.x()));
    } else if (node.num_ways < 3) {
      leave_out("the map has no branch there");
    } else if (node.num_ways > 3) {
      leave_out("crossings and slips are not made");
    } else if (met) {
      leave_out("no turnout fits there that leads to the branch, apart from others");
    } else {
      leave_out("no track of 20 m leads from it along the line");
    }
  }
  std::ranges::sort(quality_.shifts_m);
}

}  // namespace

SideTrackQuality AddSideTracks(const RailMap& map,
                               const TrackLine& track,
                               const ImportedLine& line,
                               double sigma_m,
                               LineWorld& world) {
  const LinePlaces places(map, track, line);
  SideTrackSearch search(TrackNetwork(line.alignment), line, sigma_m, world);
  world.runs = FindRuns(map, track, places);
  for (const TrackRun& run : world.runs) search.Take(run);
  search.CountSwitches(FindSwitches(map, places, kRunStrip_m));
  std::ranges::sort(search.quality().distances_m);
  return search.quality();
}

}  // namespace railcast
