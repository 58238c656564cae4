#include <algorithm>
#include <cmath>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <utility>

#include "core/base/text.h"
#include "core/rail/line/track_course.h"
#include "generator/extras/import/lines/line_heights.h"
#include "generator/extras/import/lines/line_places.h"
#include "generator/extras/import/network/level_tracks.h"
#include "generator/extras/import/network/line_world.h"
#include "generator/extras/import/network/moved_run.h"
#include "generator/extras/import/network/track_network.h"
#include "generator/extras/import/network/track_runs.h"
#include "generator/extras/import/network/turnout_search.h"

namespace railcast {
namespace {

/// Where a run meets another track, and what became of it.
struct MeetingPoint {
  Eigen::Vector2d place_m = Eigen::Vector2d::Zero();
  std::optional<double> turnout_s_m;
  std::string branch;  ///< Name of the track that begins or ends in the turnout.
};

/// A run that is being made, and the tracks that it meets.
struct OpenRun {
  TrackRun run;            ///< Where it is made.
  const TrackRun& mapped;  ///< Where the map has it.
  double sigma_m{};        ///< Sigma of its points.
  std::optional<Meeting> begin;
  std::optional<Meeting> end;

  [[nodiscard]] std::size_t num_meetings() const { return (begin ? 1U : 0U) + (end ? 1U : 0U); }
};

/// Whether a track has all of a run, but for ends without a turnout that are too short for a track.
bool Covers(const TrackDraft& draft, const TrackRun& run) {
  constexpr double kShortest_m = 30.0;
  const TrackCourse& course = draft.course;
  return (draft.spec.begin || course.begin_s_m() - run.points_m.front().x() < kShortest_m) &&
         (draft.spec.end || run.points_m.back().x() - course.end_s_m() < kShortest_m);
}

/// Whether it has the turnouts of its run, too.
bool IsWhole(const OpenRun& open, const TrackDraft& draft) {
  return draft.turnouts.size() == open.num_meetings() && Covers(draft, open.run);
}

/// A point of a plan of chainage and offset, as tracks have it.
TrackOffset OffsetAtPoint(const PlanPoint& at) {
  const double slope = std::tan(at.heading_rad);
  return {at.y_m, slope, at.curvature_per_m * std::pow(1.0 + slope * slope, 1.5)};
}

class SideTrackSearch {
 public:
  SideTrackSearch(TrackNetwork network, const ImportedLine& line, double sigma_m, LineWorld& world)
      : network_(std::move(network)),
        gauge_mm_(line.alignment.gauge_mm),
        has_turnouts_(gauge_mm_ == kStandardGauge_mm),
        sigma_m_(sigma_m),
        world_(world) {}

  /// Makes tracks of a run or of parts of it.
  /// @param number Of the run.
  /// @param below Its tunnels below the line.
  void Take(const TrackRun& run, std::size_t number, const std::vector<ChainageRange>& below) {
    number_ = number;
    why_not_ = "no turnout fits";
    for (const TrackRun& part : PartsBetween(run, below)) TakePart(part);
    const std::vector<ChainageRange> gaps = Gaps(run);
    if (gaps.empty()) return;
    const RunFit fit(run, sigma_m_);
    const auto leave_out = [&](const ChainageRange& gap, const std::string& reason) {
      world_.left_out.push_back({run.kind + " track", gap.begin_s_m, gap.end_s_m, reason, number});
    };
    for (ChainageRange gap : gaps) {
      for (const ChainageRange& tunnel : below) {
        if (tunnel.end_s_m <= gap.begin_s_m || tunnel.begin_s_m >= gap.end_s_m) continue;
        // Cuts are to a metre or two.
        constexpr double kLeast_m = 2.0;
        const ChainageRange before{gap.begin_s_m, tunnel.begin_s_m};
        const bool begins_there = tunnel.begin_s_m - gap.begin_s_m < kLeast_m;
        const bool ends_there = gap.end_s_m - tunnel.end_s_m < kLeast_m;
        if (!begins_there) leave_out(before, ReasonAgainst(run, fit, before));
        const ChainageRange in_tunnel{begins_there ? gap.begin_s_m : tunnel.begin_s_m,
                                      ends_there ? gap.end_s_m : tunnel.end_s_m};
        leave_out(
            in_tunnel,
            "it runs below track main, and all tracks of a world have the height of their line");
        gap.begin_s_m = in_tunnel.end_s_m;
      }
      if (gap.begin_s_m < gap.end_s_m) leave_out(gap, ReasonAgainst(run, fit, gap));
    }
  }

  /// Says which of the map's switches on the world's tracks are no turnouts.
  void CountSwitches(const std::vector<SwitchNode>& switches) {
    constexpr double kSame_m = 0.6;  // Nodes nearer than 0.5 m to the one before are left out.
    for (const SwitchNode& node : switches) {
      const auto leave_out = [&](const std::string& reason) {
        world_.left_out.push_back(
            {"switch", node.place_m.x(), node.place_m.x(), reason, node.node});
      };
      if (!TrackAt(node.place_m)) {
        leave_out(kOnNoTrack);
        continue;
      }
      ++world_.quality.num_switches;
      if (node.is_at_end) {
        leave_out(kAtLinesEnd);
        continue;
      }
      if (!has_turnouts_) {
        leave_out("there are turnouts of " + NumberText(kStandardGauge_mm) +
                  " mm gauge only, and the line has " + NumberText(gauge_mm_) + " mm");
        continue;
      }
      if (const auto track = network_.TrackCrossingAt(node.place_m)) {
        world_.switches.push_back({node.node, node.place_m.x(), *track});
        continue;
      }
      const MeetingPoint* met = nullptr;
      for (const MeetingPoint& meeting : meetings_) {
        if ((meeting.place_m - node.place_m).norm() > kSame_m) continue;
        if (!met || !met->turnout_s_m) met = &meeting;
      }
      if (met && met->turnout_s_m) {
        world_.switches.push_back({node.node, node.place_m.x(), met->branch});
        world_.quality.shifts_m.push_back(std::abs(*met->turnout_s_m - node.place_m.x()));
      } else if (node.num_ways < 3) {
        leave_out("the map has no branch there");
      } else if (node.num_ways > 3) {
        leave_out(network_.ReasonAgainstCrossing(node.place_m));
      } else if (met) {
        leave_out("no turnout fits there that leads to the branch, apart from others");
      } else {
        leave_out("no track of 20 m leads from it along the line");
      }
    }
    std::ranges::sort(world_.quality.shifts_m);
  }

 private:
  void TakePart(const TrackRun& part);
  /// The track on which a point lies.
  [[nodiscard]] std::optional<std::size_t> TrackAt(const Eigen::Vector2d& point_m) const {
    constexpr double kFarthest_m = 1.5;
    std::optional<std::size_t> nearest;
    double least_m = kFarthest_m;
    for (std::size_t i = 0; i < network_.tracks().size(); ++i) {
      const TrackDraft& track = network_.tracks()[i];
      if (!track.Has(point_m.x())) continue;
      const double off_m = std::abs(track.course.OffsetAt(point_m.x()).d_m - point_m.y());
      if (off_m >= least_m) continue;
      least_m = off_m;
      nearest = i;
    }
    return nearest;
  }

  [[nodiscard]] std::optional<Meeting> MeetingAt(const Eigen::Vector2d& point_m,
                                                 bool opens_ahead) const {
    if (!has_turnouts_) return std::nullopt;
    const auto track = TrackAt(point_m);
    return track ? std::optional(Meeting{*track, point_m.x(), opens_ahead}) : std::nullopt;
  }

  /// Makes one track of a run with turnouts wherever it meets others, or else with as many as
  /// possible, if it is parallel to the line.
  bool TakeAtOnce(const OpenRun& open, const RunFit& fit, std::optional<TrackDraft>& level) {
    const bool is_whole = level && IsWhole(open, *level);
    if (!is_whole && open.num_meetings() > 0 && TakeWhole(open, fit)) return true;
    if (!level || (!is_whole && level->turnouts.empty())) return false;
    const ChainageRange made{level->course.begin_s_m(), level->course.end_s_m()};
    Accept(open, std::move(*level));
    for (const auto& [from_s_m, to_s_m] : {std::pair(open.run.points_m.front().x(), made.begin_s_m),
                                           std::pair(made.end_s_m, open.run.points_m.back().x())}) {
      if (auto rest = PartOfRun(open.run, from_s_m, to_s_m)) {
        TakeFree({std::move(*rest), open.mapped, open.sigma_m, {}, {}});
      }
    }
    return true;
  }

  /// Makes a track of the whole run with turnouts wherever it meets others.
  bool TakeWhole(const OpenRun& open, const RunFit& fit) {
    std::vector<TurnoutChoice> begins;
    std::vector<TurnoutChoice> ends;
    if (open.begin) begins = TurnoutChoices(network_, open.run, fit, *open.begin);
    if (open.end) ends = TurnoutChoices(network_, open.run, fit, *open.end);
    why_not_ = "no turnout fits";
    if ((open.begin && begins.empty()) || (open.end && ends.empty())) return false;
    why_not_ = "no arcs of 120 m radius lead from a turnout to it";
    const double free_end_m = open.begin ? fit.plan.length_m() : 0.0;
    for (const TrackSpec& spec : TracksBetween(fit, open.begin ? &begins : nullptr,
                                               open.end ? &ends : nullptr, free_end_m)) {
      std::optional<TrackDraft> draft = network_.Make(spec);
      const bool follows = draft && Follows(*draft, open.run);
      if (follows && !network_.FirstConflict_m(*draft)) {
        Accept(open, std::move(*draft));
        return true;
      }
      if (follows) {
        why_not_ = "from each turnout it would come nearer than 3 m to other tracks";
      } else if (std::string_view(why_not_).starts_with("no arcs")) {
        why_not_ = draft ? "no turnout leads to where the map has it"
                         : "its turnouts would overlap with each other or with others";
      }
    }
    return false;
  }

  void TakeParts(OpenRun open, const RunFit& fit, std::optional<TrackDraft> level) {
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
    if (is_untouched && level && Covers(*level, open.run)) return Accept(open, std::move(*level));
    if (!is_untouched) {
      const auto rest = PartOfRun(open.run, from_s_m, to_s_m);
      if (!rest) return;
      open.run = *rest;
    }
    TakeFree(open);
  }

  /// A track with one turnout that is apart from others, or, if there is none, the chainage
  /// farthest from its turnout at which one comes too near to them.
  struct OneEnded {
    std::optional<TrackDraft> draft;
    std::optional<double> conflict_m;
  };
  /// The first of some tracks that is possible.
  [[nodiscard]] OneEnded BestWithOneEnd(const TrackRun& run,
                                        const std::vector<TrackSpec>& specs) const {
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

  /// Makes a track from a turnout at one end of the run as far as it is apart from others.
  /// @return Where it ends.
  std::optional<double> TakeFromOneEnd(const OpenRun& open, const RunFit& fit, bool is_begin) {
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
        Accept(open, std::move(*best.draft));
        return end_s_m;
      }
      if (!best.conflict_m) return std::nullopt;
      free_end_m = is_begin ? fit.EndBefore_m(*best.conflict_m, free_end_m)
                            : fit.BeginBehind_m(*best.conflict_m);
    }
    return std::nullopt;
  }

  /// Makes tracks without turnouts of all stretches of a run that are apart from others.
  void TakeFree(const OpenRun& open) {
    const RunFit fit(open.run, open.sigma_m);
    const std::optional<TrackDraft> whole =
        network_.Make(TrackOfPart(fit, 0.0, fit.plan.length_m()));
    const auto crosses_at = [&](double s_m) {
      constexpr double kBeside_m = 5.0;  // Farther apart by the difference to kApart_m.
      return whole && std::ranges::any_of(whole->crossings, [&](const TrackCrossing& crossing) {
               return s_m > crossing.close.begin_s_m - kBeside_m &&
                      s_m < crossing.close.end_s_m + kBeside_m;
             });
    };
    // Stretches that are apart from all others or cross them, with ends at whole metres of the fit.
    std::vector<ChainageRange> free;
    bool goes_on = false;
    for (double at_m = 0.0; at_m <= fit.plan.length_m(); ++at_m) {
      const PlanPoint at = fit.course.At(at_m);
      const bool fits = at.x_m >= 0.0 && at.x_m <= network_.length_m() &&
                        (network_.IsApartAt(at.x_m, at.y_m) || crosses_at(at.x_m)) &&
                        network_.HasRoom(at.x_m, OffsetAtPoint(at));
      if (fits && !goes_on) free.push_back({at_m, at_m});
      if (fits) free.back().end_s_m = at_m;
      goes_on = fits;
    }
    for (const ChainageRange& stretch : free) TakeStretch(open, fit, stretch);
  }

  /// @param stretch Of the fit.
  void TakeStretch(const OpenRun& open, const RunFit& fit, const ChainageRange& stretch) {
    constexpr double kShortest_m = 30.0;
    const double from_m = fit.OutOfClothoid_m(stretch.begin_s_m, false);
    const double to_m = fit.OutOfClothoid_m(stretch.end_s_m, true);
    if (to_m - from_m < kShortest_m) return;
    std::optional<TrackDraft> draft = network_.Make(TrackOfPart(fit, from_m, to_m));
    if (!draft) return;
    if (const auto conflict_s_m = network_.FirstConflict_m(*draft)) {
      TakeStretch(open, fit, {from_m, fit.EndBefore_m(*conflict_s_m, to_m)});
      const double behind_m = fit.BeginBehind_m(*conflict_s_m);
      if (behind_m > from_m) TakeStretch(open, fit, {behind_m, to_m});
      return;
    }
    Accept(open, std::move(*draft));
  }

  void Accept(const OpenRun& open, TrackDraft draft) {
    const TrackRun& run = open.mapped;
    draft.spec.name = run.kind + "_" + std::to_string(++num_of_kind_[run.kind]);
    draft.spec.electrified = run.is_electrified;
    world_.tracks.push_back({draft, run.ways, number_});
    for (const Eigen::Vector2d& point_m : run.points_m) {
      if (!draft.Has(point_m.x())) continue;
      const double off_m = point_m.y() - draft.course.OffsetAt(point_m.x()).d_m;
      world_.tracks.back().off_m.emplace_back(point_m.x(), off_m);
      world_.quality.distances_m.push_back(std::abs(off_m));
    }
    for (const TurnoutSite& turnout : draft.turnouts) {
      const Eigen::Vector2d& place_m =
          turnout.opens_ahead() ? run.points_m.front() : run.points_m.back();
      for (MeetingPoint& meeting : meetings_) {
        if (meeting.place_m != place_m) continue;
        meeting.turnout_s_m = turnout.s_m;
        meeting.branch = draft.spec.name;
      }
    }
    for (const TrackCrossing& crossing : draft.crossings) {
      const std::size_t other = std::min(crossing.site.first, crossing.site.second);
      world_.crossings.push_back({.tracks = {network_.tracks()[other].spec.name, draft.spec.name},
                                  .s_m = RoundedTo(crossing.site.s_m, 1e3)});
      world_.level.push_back({crossing.site.begin_s_m, crossing.site.end_s_m});
    }
    ++world_.quality.num_tracks;
    world_.quality.num_turnouts += draft.turnouts.size();
    world_.quality.length_m += draft.course.end_s_m() - draft.course.begin_s_m();
    network_.Add(std::move(draft));
  }

  /// The stretches of a run that are in none of its tracks.
  [[nodiscard]] std::vector<ChainageRange> Gaps(const TrackRun& run) const {
    std::vector<ChainageRange> made{{run.points_m.back().x(), run.points_m.back().x()}};
    for (const WorldTrack& track : world_.tracks) {
      if (track.run == number_) made.push_back(RangeInRun(world_, track));
    }
    std::ranges::sort(made, {}, &ChainageRange::begin_s_m);
    std::vector<ChainageRange> gaps;
    double from_s_m = run.points_m.front().x();
    for (const ChainageRange& range : made) {
      if (range.begin_s_m > from_s_m) gaps.push_back({from_s_m, range.begin_s_m});
      from_s_m = std::max(from_s_m, range.end_s_m);
    }
    return gaps;
  }

  /// Why the greater part of a stretch of a run is no track.
  [[nodiscard]] std::string ReasonAgainst(const TrackRun& run,
                                          const RunFit& fit,
                                          const ChainageRange& stretch) const {
    std::map<std::string, int> metres;
    for (double at_m = 0.0; at_m <= fit.plan.length_m(); ++at_m) {
      const PlanPoint at = fit.course.At(at_m);
      if (at.x_m < stretch.begin_s_m || at.x_m > stretch.end_s_m) continue;
      if (const auto near = network_.TrackNear(at.x_m, at.y_m)) {
        const auto meets_at = [&](const Eigen::Vector2d& point_m) {
          return std::abs(at.x_m - point_m.x()) < kMeeting_m && TrackAt(point_m) == near;
        };
        const bool meets = meets_at(run.points_m.front()) || meets_at(run.points_m.back());
        const std::string& name = network_.tracks()[*near].spec.name;
        ++metres[meets
                     ? "it leaves track " + name + " there, and " + why_not_
                     : "it is nearer than 3.15 m to track " + name + " and has no room beside it"];
      } else if (!network_.IsOnGround(at.x_m, at.y_m)) {
        ++metres["it leaves the ground of the line"];
      } else if (!network_.HasRoom(at.x_m, OffsetAtPoint(at))) {
        ++metres["its radius would be too small"];
      }
    }
    if (metres.empty()) return "what is left of it there is too short";
    return std::ranges::max_element(metres, {}, [](const auto& entry) { return entry.second; })
        ->first;
  }

  TrackNetwork network_;
  double gauge_mm_;
  bool has_turnouts_;  ///< There are none of other gauges.
  double sigma_m_;
  LineWorld& world_;
  std::size_t number_{};   ///< Number of the run that is being made.
  const char* why_not_{};  ///< A track of it cannot have all of its turnouts.
  std::map<std::string, int> num_of_kind_;
  std::vector<MeetingPoint> meetings_;
};

void SideTrackSearch::TakePart(const TrackRun& run) {
  OpenRun open{run, run, sigma_m_, MeetingAt(run.points_m.front(), true),
               MeetingAt(run.points_m.back(), false)};
  for (const auto& [meeting, point_m] :
       {std::pair(open.begin, run.points_m.front()), std::pair(open.end, run.points_m.back())}) {
    if (meeting) meetings_.push_back({point_m, std::nullopt, ""});
  }
  std::optional<TrackDraft> level = LevelTrackOf(network_, run, open.begin, open.end);
  if (level && IsWhole(open, *level)) return Accept(open, std::move(*level));
  const RunFit fit(run, sigma_m_);
  if (TakeAtOnce(open, fit, level)) return;
  std::optional<TrackRun> moved = MovedApart(network_, run, fit);
  if (!moved) return TakeParts(std::move(open), fit, std::move(level));
  open.run = std::move(*moved);
  open.sigma_m = kMovedSigma_m;
  const RunFit moved_fit(open.run, open.sigma_m);
  level = LevelTrackOf(network_, open.run, open.begin, open.end);
  if (!TakeAtOnce(open, moved_fit, level)) TakeParts(std::move(open), moved_fit, std::move(level));
}

/// The line without the cant by the rule wherever tracks may cross.
AlignmentSpec AlignmentForCrossings(const RailMap& map,
                                    const TrackLine& track,
                                    const ImportedLine& line,
                                    const std::vector<Eigen::Vector2d>& crossings_m) {
  // A crossing's place is known to 15 m along the line. At 1:20, its frogs are 34 m from that.
  constexpr double kHalf_m = 50.0;
  AlignmentSpec alignment = line.alignment;
  if (HasSurveyedCant(map, track)) return alignment;
  std::vector<ChainageRange> level;
  for (const Eigen::Vector2d& place_m : crossings_m) {
    level.push_back({place_m.x() - kHalf_m, place_m.x() + kHalf_m});
  }
  LevelCant(level, alignment);
  return alignment;
}

}  // namespace

void AddSideTracks(const RailMap& map,
                   const TrackLine& track,
                   const ImportedLine& line,
                   const ImportOptions& options,
                   LineWorld& world) {
  const LinePlaces places(map, track, line);
  const std::vector<SwitchNode> switches = FindSwitches(map, places, kRunStrip_m);
  std::vector<Eigen::Vector2d> crossings_m;
  for (const SwitchNode& node : switches) {
    if (node.num_ways > 3 && !node.is_at_end) crossings_m.push_back(node.place_m);
  }
  const AlignmentSpec alignment = AlignmentForCrossings(map, track, line, crossings_m);
  SideTrackSearch search(TrackNetwork(alignment, std::move(crossings_m)), line, options.sigma_m,
                         world);
  world.beside = FindRuns(map, track, places, options.otherwise_kmph);
  for (std::size_t i = 0; i < world.beside.runs.size(); ++i) {
    const TrackRun& run = world.beside.runs[i];
    const auto below = TunnelsBelowLine(map, world.tracks.front().ways, run);
    for (const ChainageRange& tunnel : below) {
      world.left_out.push_back({"tunnel", tunnel.begin_s_m, tunnel.end_s_m,
                                "it runs below track main, and all tracks of a world have the "
                                "height of their line"});
    }
    search.Take(run, i, below);
  }
  search.CountSwitches(switches);
  std::ranges::sort(world.quality.distances_m);
}

}  // namespace railcast
