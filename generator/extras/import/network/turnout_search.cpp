#include "generator/extras/import/network/turnout_search.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <utility>

#include "core/rail/line/plan_course.h"
#include "core/rail/network/turnout_place.h"
#include "generator/extras/import/fit/plan_model.h"

namespace railcast {
namespace {

constexpr double kSharpestArc_per_m = 1.0 / 120.0;
/// An arc of 250 m costs 1.
constexpr double kUsualArc_m = 250.0;

/// A cut is this far from where a track comes too near to others, and sought in these steps.
constexpr double kCutMargin_m = 1.0;
constexpr double kCutStep_m = 0.5;

double Squared(double value) {
  return value * value;
}

struct SpeedOfTurnout {
  TurnoutType type{};
  double speed_kmph{};
};
constexpr std::array<SpeedOfTurnout, 4> kTurnouts = {{{TurnoutType::k9_190, 40.0},
                                                      {TurnoutType::k9_300, 50.0},
                                                      {TurnoutType::k12_500, 60.0},
                                                      {TurnoutType::k14_760, 80.0}}};

std::size_t TurnoutIndexFor(double speed_kmph) {
  std::size_t index = 0;
  while (index + 1 < kTurnouts.size() && kTurnouts[index].speed_kmph < speed_kmph) ++index;
  return index;
}

/// Best join of the end of a branch to the fit of its run: by two arcs, with the fit from there on.
void FindJoin(const RunFit& fit, double foot_m, bool is_begin, TurnoutChoice& choice) {
  constexpr std::array<double, 8> kLengths_m = {8.0, 15.0, 25.0, 40.0, 60.0, 90.0, 130.0, 180.0};
  constexpr double kUsualLength_m = 80.0;
  for (const double length_m : kLengths_m) {
    const double at_m = fit.OutOfClothoid_m(foot_m + (is_begin ? length_m : -length_m), !is_begin);
    if (at_m < 0.0 || at_m > fit.plan.length_m()) break;
    const PlanPoint point = fit.course.At(at_m);
    const auto arcs =
        is_begin ? BiarcBetween(choice.behind, point) : BiarcBetween(point, choice.behind);
    if (!arcs || arcs->sharpest_per_m() > kSharpestArc_per_m) continue;
    const double cost =
        Squared(arcs->sharpest_per_m() * kUsualArc_m) + Squared(arcs->length_m() / kUsualLength_m);
    if (choice.has_join && cost >= choice.join_cost) continue;
    choice.has_join = true;
    choice.join_cost = cost;
    choice.join_m = at_m;
  }
}

std::optional<TurnoutChoice> ChoiceAt(const TrackNetwork& network,
                                      const RunFit& fit,
                                      const Meeting& meeting,
                                      const TurnoutSpec& spec) {
  const TurnoutPlace place = network.PlaceOf(spec, meeting.opens_ahead);
  const double s_m = *spec.s_m;
  const double forwards = meeting.opens_ahead ? 1.0 : -1.0;
  const double end_s_m = s_m + forwards * place.geometry.length_m;
  const TrackCourse& course = place.course;
  if (std::min(s_m, end_s_m) < course.begin_s_m() || std::max(s_m, end_s_m) > course.end_s_m() ||
      !network.IsFree(meeting.track, s_m, end_s_m)) {
    return std::nullopt;
  }
  WorldFaults faults;
  const auto through = CurvatureThrough(place, s_m, faults);
  if (!through) return std::nullopt;
  BranchCourse branch(course, s_m, !meeting.opens_ahead);
  branch.AddTurnout(place.geometry, SignOf(*spec.side), *through);
  TurnoutChoice choice{
      .spec = spec, .behind = branch.EndTowardsRising(), .track_slope = course.OffsetAt(s_m).slope};
  // Where there is another way, no turnout stands in the way of a crossing.
  constexpr double kInCrossing_m = 1.0;
  choice.off_cost =
      Squared(network.InMappedCrossings_m(meeting.track, s_m, end_s_m) / kInCrossing_m);
  const double guess_m = choice.behind.x_m - fit.plan.start.x_m;
  const Foot foot =
      FootOn(fit.course, fit.plan.length_m(), {choice.behind.x_m, choice.behind.y_m}, guess_m);
  constexpr double kOff_m = 0.4;
  constexpr double kFarthest_m = 1.6;
  constexpr double kTurn_rad = 0.03;
  const bool is_beside = std::abs(foot.beyond_m) < 1.0;
  if (is_beside && std::abs(foot.offset_m) > kFarthest_m) return std::nullopt;
  if (is_beside) {
    choice.off_cost +=
        Squared(foot.offset_m / kOff_m) +
        Squared((fit.course.At(foot.s_m).heading_rad - choice.behind.heading_rad) / kTurn_rad);
    FindJoin(fit, foot.s_m, meeting.opens_ahead, choice);
  }
  return choice;
}

void AddArc(double length_m, double per_m, std::vector<AlignmentElement>& elements) {
  constexpr double kLeast_per_m = 1e-6;
  const double rounded_m = RoundedTo(length_m, 1e4);
  if (rounded_m < 0.01) return;
  if (std::abs(per_m) < kLeast_per_m) {
    elements.push_back({ElementType::kStraight, rounded_m, {}});
  } else {
    elements.push_back({ElementType::kArc, rounded_m, RoundedTo(1.0 / per_m, 1e6)});
  }
}

/// A track along the fit from one length to another, behind a turnout if there is one.
std::vector<AlignmentElement> ElementsAlong(const RunFit& fit,
                                            const TurnoutChoice* begin,
                                            double begin_m,
                                            double end_m) {
  std::vector<AlignmentElement> elements;
  if (begin) {
    const auto arcs = BiarcBetween(begin->behind, fit.course.At(begin_m));
    AddArc(arcs->first_m, arcs->first_per_m, elements);
    AddArc(arcs->second_m, arcs->second_per_m, elements);
  }
  if (end_m - begin_m < 1.0) return elements;
  for (const AlignmentElement& element : fit.Part(begin_m, end_m).Elements()) {
    elements.push_back(element);
  }
  return elements;
}

/// A track of one arc between the end of a branch and a place aside from the free end of a fit:
/// where the map has a branch for so short a way that no two arcs lead to the fit and along it.
std::optional<TrackSpec> ArcToFreeEnd(const TurnoutChoice& choice,
                                      const PlanPoint& free_end,
                                      double aside_m,
                                      bool is_begin) {
  constexpr double kLongest_m = 60.0;
  constexpr double kShortest_m = 1.0;
  const Eigen::Vector2d chord_m =
      Eigen::Rotation2D<double>(-choice.behind.heading_rad) *
      Eigen::Vector2d(free_end.x_m - choice.behind.x_m, free_end.y_m + aside_m - choice.behind.y_m);
  const double ahead_m = is_begin ? chord_m.x() : -chord_m.x();
  const double per_m = 2.0 * chord_m.y() / chord_m.squaredNorm();
  if (ahead_m < kShortest_m || chord_m.norm() > kLongest_m ||
      std::abs(per_m) > kSharpestArc_per_m) {
    return std::nullopt;
  }
  const double half_turn_rad = std::atan2(chord_m.y(), ahead_m);
  const double length_m = per_m == 0.0 ? ahead_m : std::abs(2.0 * half_turn_rad / per_m);
  TrackSpec spec;
  if (is_begin) {
    AddArc(length_m, per_m, spec.elements);
    spec.begin = choice.spec;
    return spec;
  }
  // Two arcs lead on to the turnout at an end, here along the same circle.
  AddArc(0.5 * length_m, per_m, spec.elements);
  spec.end = choice.spec;
  spec.offset_m = RoundedTo(free_end.y_m + aside_m, 1e4);
  spec.start_s_m = RoundedTo(free_end.x_m, 1e4);
  const double heading_rad = choice.behind.heading_rad - length_m * per_m;
  spec.heading_deg = RoundedTo(heading_rad * 180.0 / std::numbers::pi, 1e7);
  return spec;
}

struct Pairing {
  const TurnoutChoice* begin{};
  const TurnoutChoice* end{};
  bool is_direct{};
  double cost{};
  double end_shift_m = 0.0;  ///< By which the turnout at the end is moved along its track.
};

/// Two turnouts of which the branches lead to each other, without or with a shift of the second one
/// within the steps at which turnouts are sought, so that no sharp arcs make up for these.
std::optional<Pairing> DirectPairing(const TurnoutChoice& begin, const TurnoutChoice& end) {
  constexpr double kLongest_m = 250.0;
  constexpr double kLeast_m = 0.5;
  constexpr double kMostShift_m = 0.6;
  const auto arcs_to = [&](double shift_m) -> std::optional<Biarc> {
    PlanPoint to = end.behind;
    to.x_m += shift_m;
    to.y_m += shift_m * end.track_slope;
    const double between_m = to.x_m - begin.behind.x_m;
    if (between_m <= kLeast_m || between_m >= kLongest_m) return std::nullopt;
    const auto arcs = BiarcBetween(begin.behind, to);
    return arcs && arcs->sharpest_per_m() <= kSharpestArc_per_m ? arcs : std::nullopt;
  };
  double shift_m = 0.0;
  auto arcs = arcs_to(shift_m);
  if (!arcs) {
    // To where the chord has the mean of both headings: with equal ones, the way is straight.
    const double slope = std::tan(0.5 * (begin.behind.heading_rad + end.behind.heading_rad));
    const double off_m =
        end.behind.y_m - begin.behind.y_m - slope * (end.behind.x_m - begin.behind.x_m);
    shift_m = RoundedTo(off_m / (slope - end.track_slope), 1e3);
    if (std::abs(shift_m) > kMostShift_m) return std::nullopt;
    arcs = arcs_to(shift_m);
  }
  if (!arcs) return std::nullopt;
  const double between_m = end.behind.x_m + shift_m - begin.behind.x_m;
  return Pairing{&begin, &end, true,
                 begin.off_cost + end.off_cost + Squared(arcs->sharpest_per_m() * kUsualArc_m) +
                     Squared(between_m / 100.0),
                 shift_m};
}

std::vector<Pairing> Pairings(const std::vector<TurnoutChoice>& begins,
                              const std::vector<TurnoutChoice>& ends) {
  std::vector<Pairing> pairings;
  for (const TurnoutChoice& begin : begins) {
    for (const TurnoutChoice& end : ends) {
      const double off_cost = begin.off_cost + end.off_cost;
      if (const auto direct = DirectPairing(begin, end)) pairings.push_back(*direct);
      if (begin.has_join && end.has_join && begin.join_m < end.join_m) {
        pairings.push_back({&begin, &end, false, off_cost + begin.join_cost + end.join_cost});
      }
    }
  }
  std::ranges::stable_sort(pairings, {}, &Pairing::cost);
  return pairings;
}

}  // namespace

std::vector<SwitchNode> SwitchesOf(const RailMap& map) {
  std::vector<std::size_t> num_ways(map.nodes.size());
  for (const MapWay& way : map.ways) {
    for (std::size_t i = 0; i < way.nodes.size(); ++i) {
      num_ways[way.nodes[i]] += i == 0 || i + 1 == way.nodes.size() ? 1 : 2;
    }
  }
  std::vector<SwitchNode> switches;
  for (std::size_t i = 0; i < map.nodes.size(); ++i) {
    const bool is_tagged = num_ways[i] > 0 && TagOf(map.nodes[i].tags, "railway") == "switch";
    if (num_ways[i] >= 3 || is_tagged) switches.push_back({i, num_ways[i]});
  }
  return switches;
}

std::vector<SwitchNode> FindSwitches(const RailMap& map,
                                     const LinePlaces& places,
                                     double farthest_m) {
  std::vector<SwitchNode> switches;
  for (SwitchNode node : SwitchesOf(map)) {
    const auto place = places.Of(map.nodes[node.node].place_m, farthest_m);
    constexpr double kAtEnd_m = 1.0;
    if (!place || std::abs(place->beyond_m) > kAtEnd_m) continue;
    node.place_m = {place->s_m, place->d_m};
    node.is_at_end = place->s_m < kAtEnd_m || place->s_m > places.length_m() - kAtEnd_m;
    switches.push_back(node);
  }
  std::ranges::stable_sort(switches, {}, [](const SwitchNode& node) { return node.place_m.x(); });
  return switches;
}

TurnoutType TurnoutFor(double speed_kmph) {
  return kTurnouts[TurnoutIndexFor(speed_kmph)].type;
}

RunFit::RunFit(const TrackRun& run, double sigma_m)
    : plan(FitLine(run.points_m,
                   {.sigma_m = sigma_m,
                    .speed_kmph =
                        [&](double along_m) {
                          return SpeedOfRun_kmph(run, run.points_m.front().x() + along_m);
                        }})
               .plan),
      course(plan.Course()) {}

double RunFit::OutOfClothoid_m(double at_m, bool backwards) const {
  for (std::size_t i = 0; i + 1 < plan.plateaus.size(); ++i) {
    const double from_m = plan.ConstantBegin_m(i) + plan.ConstantLength_m(i);
    const double to_m = plan.ConstantBegin_m(i + 1);
    if (at_m > from_m && at_m < to_m) return backwards ? from_m : to_m;
  }
  return at_m;
}

double RunFit::EndBefore_m(double conflict_s_m, double most_m) const {
  double at_m = most_m;
  while (at_m > 0.0 && course.At(at_m).x_m > conflict_s_m - kCutMargin_m) at_m -= kCutStep_m;
  return OutOfClothoid_m(at_m, true);
}

double RunFit::BeginBehind_m(double conflict_s_m) const {
  double at_m = 0.0;
  while (at_m < plan.length_m() && course.At(at_m).x_m < conflict_s_m + kCutMargin_m) {
    at_m += kCutStep_m;
  }
  return OutOfClothoid_m(at_m, false);
}

std::vector<TurnoutChoice> TurnoutChoices(const TrackNetwork& network,
                                          const TrackRun& run,
                                          const RunFit& fit,
                                          const Meeting& meeting) {
  constexpr double kOtherType = 0.5;
  constexpr double kLeastAside_m = 0.05;
  constexpr std::size_t kMost = 60;
  const TrackDraft& track = network.tracks()[meeting.track];
  const double forwards = meeting.opens_ahead ? 1.0 : -1.0;
  std::vector<TurnoutChoice> choices;
  const auto wished = static_cast<double>(TurnoutIndexFor(SpeedOfRun_kmph(run, meeting.s_m)));
  constexpr double kAside_m = 28.0;
  const double reach_m = run.points_m.back().x() - run.points_m.front().x();
  // Where the map has the run beside the track by less than either is off, farther ahead.
  double aside_m = 0.0;
  for (double ahead_m = std::min(kAside_m, 0.5 * reach_m); ahead_m < reach_m; ahead_m += 10.0) {
    const double aside_s_m = meeting.s_m + forwards * ahead_m;
    if (!track.Has(aside_s_m)) return choices;
    aside_m = OffsetOf_m(run.points_m, aside_s_m) - track.course.OffsetAt(aside_s_m).d_m;
    if (std::abs(aside_m) >= kLeastAside_m) break;
  }
  if (std::abs(aside_m) < kLeastAside_m) return choices;
  // The branch of 1:14-760 is 0.52 m aside there.
  constexpr double kSlender_m = 0.4;
  const bool is_slender = reach_m > 2.0 * kAside_m && std::abs(aside_m) < kSlender_m;
  const double usual_before_m = is_slender ? -15.0 : 4.0;
  const double spread_m = is_slender ? 15.0 : 5.0;
  for (std::size_t type = 0; type < kTurnouts.size(); ++type) {
    for (double before_m = is_slender ? -40.0 : -6.0; before_m <= 14.0; ++before_m) {
      TurnoutSpec spec{.track = track.spec.name,
                       .s_m = RoundedTo(meeting.s_m - forwards * before_m, 1e3),
                       .turnout = kTurnouts[type].type,
                       .side = aside_m > 0.0 ? TrackSide::kLeft : TrackSide::kRight,
                       .position = {}};
      std::optional<TurnoutChoice> choice = ChoiceAt(network, fit, meeting, spec);
      if (!choice) continue;
      choice->off_cost += Squared((before_m - usual_before_m) / spread_m) +
                          kOtherType * Squared(static_cast<double>(type) - wished);
      choices.push_back(std::move(*choice));
    }
  }
  std::ranges::stable_sort(choices, {}, [](const TurnoutChoice& choice) {
    return choice.off_cost + (choice.has_join ? choice.join_cost : 1.0);
  });
  if (choices.size() > kMost) choices.resize(kMost);
  return choices;
}

TrackSpec TrackOfPart(const RunFit& fit, double begin_m, double end_m) {
  const PlanPoint start = fit.course.At(begin_m);
  TrackSpec spec;
  spec.offset_m = RoundedTo(start.y_m, 1e4);
  spec.elements = ElementsAlong(fit, nullptr, begin_m, end_m);
  spec.heading_deg = RoundedTo(start.heading_rad * 180.0 / std::numbers::pi, 1e7);
  spec.start_s_m = RoundedTo(start.x_m, 1e4);
  return spec;
}

std::vector<TrackSpec> TracksBetween(const RunFit& fit,
                                     const std::vector<TurnoutChoice>* begin,
                                     const std::vector<TurnoutChoice>* end,
                                     double free_end_m) {
  std::vector<TrackSpec> specs;
  if (begin && end) {
    for (const Pairing& pairing : Pairings(*begin, *end)) {
      TrackSpec spec;
      if (!pairing.is_direct) {
        spec.elements =
            ElementsAlong(fit, pairing.begin, pairing.begin->join_m, pairing.end->join_m);
      }
      spec.begin = pairing.begin->spec;
      spec.end = pairing.end->spec;
      if (pairing.end_shift_m != 0.0) {
        spec.end->s_m = RoundedTo(*spec.end->s_m + pairing.end_shift_m, 1e3);
      }
      specs.push_back(std::move(spec));
      constexpr std::size_t kMost = 150;
      if (specs.size() == kMost) break;
    }
    return specs;
  }
  for (const TurnoutChoice& choice : begin ? *begin : *end) {
    if (!choice.has_join) continue;
    if (begin && choice.join_m < free_end_m) {
      TrackSpec spec;
      spec.elements = ElementsAlong(fit, &choice, choice.join_m, free_end_m);
      spec.begin = choice.spec;
      specs.push_back(std::move(spec));
    } else if (end && free_end_m < choice.join_m) {
      TrackSpec spec = TrackOfPart(fit, free_end_m, choice.join_m);
      spec.end = choice.spec;
      specs.push_back(std::move(spec));
    }
  }
  // Within what a track may be off its run.
  constexpr std::array<double, 5> kAside_m = {0.0, 0.5, -0.5, 0.9, -0.9};
  const PlanPoint free_end = fit.course.At(free_end_m);
  for (const TurnoutChoice& choice : begin ? *begin : *end) {
    for (const double aside_m : kAside_m) {
      auto spec = ArcToFreeEnd(choice, free_end, aside_m, begin != nullptr);
      if (spec) specs.push_back(std::move(*spec));
    }
  }
  return specs;
}

}  // namespace railcast
