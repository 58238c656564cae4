#include "core/rail/network/network_draft.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <utility>
#include <vector>

#include "core/base/text.h"
#include "core/base/units.h"
#include "core/rail/line/alignment_course.h"
#include "core/rail/line/plan_course.h"
#include "core/rail/network/turnout_place.h"

namespace railcast {
namespace {

constexpr double kEndless_m = std::numeric_limits<double>::infinity();
constexpr double kSteepest_rad = 0.25 * std::numbers::pi;
/// Rounding of chainages and offsets that a specification gives with few digits.
constexpr double kRounding_m = 1e-3;

bool IsCrossover(const TrackSpec& track) {
  return track.begin && track.end && !track.offset_m && track.offsets_m.empty() &&
         track.elements.empty();
}

/// What may not be given beside something else.
void CheckKeys(const IndependentTrack& own, WorldFaults& faults) {
  const TrackSpec& track = own.spec;
  const auto forbid = [&](bool is_given, const char* key, const char* rule) {
    if (is_given) faults.Add(own.pointer + key, rule);
  };
  const bool has_elements = !track.elements.empty();
  forbid(track.offset_m && !track.offsets_m.empty(), "/offsets_m",
         "must not be given beside offset_m");
  forbid(has_elements && !track.offsets_m.empty(), "/elements",
         "must not be given beside offsets_m");
  forbid(has_elements && track.begin && track.offset_m, "/offset_m",
         "must not be given for elements behind a turnout");
  forbid(track.heading_deg != 0.0 && (!has_elements || track.begin), "/heading_deg",
         "must be given for elements without a turnout at their beginning only");
  forbid(has_elements && track.end_s_m, "/end_s_m",
         "must not be given with elements: the track ends where they do, or in a turnout");
  forbid(track.begin && track.start_s_m != 0.0, "/start_s_m",
         "must not be given beside a turnout at the beginning");
  forbid(track.end && track.end_s_m, "/end_s_m", "must not be given beside a turnout at the end");
  forbid(track.begin && !track.begin->s_m, "/begin",
         "must have s_m, the chainage of the turnout's beginning");
  forbid(track.end && !track.end->s_m && !IsCrossover(track), "/end",
         "must have s_m, the chainage of the turnout's beginning");
}

/// The offsets of a track between its turnouts, over all chainages. Absent after a fault.
std::vector<CoursePiece> PiecesOfOffsets(const IndependentTrack& own, WorldFaults& faults) {
  const auto level = [](double begin_s_m, double end_s_m, double d_m) {
    return CoursePiece{.kind = CoursePiece::Kind::kLevel,
                       .begin_s_m = begin_s_m,
                       .end_s_m = end_s_m,
                       .begin_d_m = d_m,
                       .end_d_m = d_m,
                       .plan = nullptr};
  };
  const std::vector<ChainageValue>& offsets = own.spec.offsets_m;
  if (offsets.empty()) return {level(-kEndless_m, kEndless_m, own.spec.offset_m.value_or(0.0))};
  std::vector<CoursePiece> pieces;
  double begin_s_m = -kEndless_m;
  for (std::size_t i = 1; i < offsets.size(); ++i) {
    const ChainageValue& from = offsets[i - 1];
    const ChainageValue& to = offsets[i];
    if (!(to.s_m > from.s_m)) {
      faults.Add(own.pointer + "/offsets_m/" + std::to_string(i) + "/s_m",
                 "must be greater than " + NumberText(from.s_m) + " before it", NumberText(to.s_m));
      return {};
    }
    if (from.value == to.value) continue;
    if (begin_s_m < from.s_m) pieces.push_back(level(begin_s_m, from.s_m, from.value));
    pieces.push_back({.kind = CoursePiece::Kind::kSCurve,
                      .begin_s_m = from.s_m,
                      .end_s_m = to.s_m,
                      .begin_d_m = from.value,
                      .end_d_m = to.value,
                      .plan = nullptr});
    begin_s_m = to.s_m;
  }
  pieces.push_back(level(begin_s_m, kEndless_m, offsets.back().value));
  return pieces;
}

TurnoutSite SiteOf(const TurnoutPlace& place, double s_m, TrackSide side) {
  return {.track = place.track,
          .branch = 0,
          .type = place.spec.turnout,
          .s_m = s_m,
          .end_s_m = TurnoutEnd_m(place, s_m),
          .side = side,
          .position = place.spec.position.value_or(TurnoutPosition::kStraight),
          .fouling_s_m = {},
          .has_given_position = place.spec.position.has_value()};
}

/// The side to which the branch leaves towards the offset `d_m`, unless the spec says it.
std::optional<TrackSide> SideTowards(const TurnoutPlace& place,
                                     double s_m,
                                     std::optional<double> d_m,
                                     WorldFaults& faults) {
  if (place.spec.side) return place.spec.side;
  const double main_d_m = place.course.OffsetAt(s_m).d_m;
  if (!d_m || std::abs(*d_m - main_d_m) < kRounding_m) {
    faults.Add(place.pointer, d_m ? "must have a side, because its track has the offset of track " +
                                        Quoted(place.spec.track)
                                  : std::string("must have a side for a track with elements"));
    return std::nullopt;
  }
  return *d_m > main_d_m ? TrackSide::kLeft : TrackSide::kRight;
}

/// A way out of a turnout and its turnout.
struct WayOut {
  BranchCourse branch;
  TurnoutSite site;
};

std::optional<WayOut> LeaveTurnout(const TurnoutPlace& place,
                                   std::optional<double> d_m,
                                   WorldFaults& faults) {
  const double s_m = *place.spec.s_m;
  const auto side = SideTowards(place, s_m, d_m, faults);
  const auto through = CurvatureThrough(place, s_m, faults);
  if (!side || !through) return std::nullopt;
  WayOut way{BranchCourse(place.course, s_m, !place.opens_ahead), SiteOf(place, s_m, *side)};
  way.branch.AddTurnout(place.geometry, SignOf(*side), *through);
  return way;
}

/// A way out of a turnout to where it is parallel to the alignment at the offset `d_m`.
std::optional<WayOut> LeaveTowards(const IndependentTrack& own,
                                   const TurnoutPlace& place,
                                   double d_m,
                                   WorldFaults& faults) {
  std::optional<WayOut> way = LeaveTurnout(place, d_m, faults);
  if (!way) return way;
  const auto nearest_m = way->branch.AddReturnTo(d_m, place.geometry.radius_m);
  if (nearest_m) {
    const bool is_parallel = std::abs(way->branch.end().heading_rad) < 1e-9;
    const char* far = way->site.side == TrackSide::kLeft ? " or more" : " or less";
    faults.Add(own.pointer + (own.spec.offsets_m.empty() ? "/offset_m" : "/offsets_m"),
               "must be " + MetresText(*nearest_m) + (is_parallel ? "" : far) +
                   ", where a turnout " + std::string(NameOf(place.spec.turnout)) + " from track " +
                   Quoted(place.spec.track) +
                   (is_parallel ? " leaves it" : " and the curve behind it lead at least"),
               NumberText(d_m));
    return std::nullopt;
  }
  return way;
}

void CheckSteepness(const IndependentTrack& own, const BranchCourse& branch, WorldFaults& faults) {
  if (branch.steepest_rad() <= kSteepest_rad) return;
  faults.Add(own.pointer, "must run within 45 degrees of the alignment",
             ShortText(DegFromRad(branch.steepest_rad())));
}

/// Tracks with offsets, and turnouts at their beginning, their end, or both.
IndependentCourse CourseOfOffsets(const IndependentTrack& own, WorldFaults& faults) {
  const std::vector<CoursePiece> offsets = PiecesOfOffsets(own, faults);
  if (offsets.empty()) return {};
  std::optional<WayOut> begin;
  std::optional<WayOut> end;
  if (own.begin) begin = LeaveTowards(own, *own.begin, offsets.front().begin_d_m, faults);
  if (own.end) end = LeaveTowards(own, *own.end, offsets.back().end_d_m, faults);
  if (own.begin.has_value() != begin.has_value() || own.end.has_value() != end.has_value()) {
    return {};
  }
  IndependentCourse made;
  const double begin_s_m = begin ? begin->site.s_m : own.spec.start_s_m;
  const double end_s_m = end ? end->site.s_m : own.spec.end_s_m.value_or(own.line_length_m);
  const double parallel_from_m = begin ? begin->branch.end_s_m() : begin_s_m;
  const double parallel_to_m = end ? end->branch.end_s_m() : end_s_m;
  if (!(parallel_from_m <= parallel_to_m)) {
    faults.Add(own.pointer + (end ? "/end/s_m" : "/end_s_m"),
               "must be at least " + MetresText(end_s_m + parallel_from_m - parallel_to_m) +
                   ", for the track to become parallel to the alignment before it",
               NumberText(end_s_m));
    return {};
  }
  const bool changes = offsets.size() > 1;
  if (changes && begin && offsets.front().end_s_m < parallel_from_m) {
    faults.Add(own.pointer + "/offsets_m",
               "must not change before " + MetresText(parallel_from_m) +
                   ", where the track is parallel to the alignment behind its turnout",
               NumberText(offsets.front().end_s_m));
    return {};
  }
  if (changes && end && offsets.back().begin_s_m > parallel_to_m) {
    faults.Add(own.pointer + "/offsets_m",
               "must not change after " + MetresText(parallel_to_m) +
                   ", up to where the track is parallel to the alignment before its turnout",
               NumberText(offsets.back().begin_s_m));
    return {};
  }
  std::vector<CoursePiece> pieces;
  if (begin) pieces.push_back(begin->branch.Piece(begin_s_m, parallel_from_m));
  for (CoursePiece piece : offsets) {
    if (piece.kind == CoursePiece::Kind::kLevel) {
      piece.begin_s_m = std::max(piece.begin_s_m, parallel_from_m);
      piece.end_s_m = std::min(piece.end_s_m, parallel_to_m);
      if (!(piece.begin_s_m < piece.end_s_m)) continue;
    }
    pieces.push_back(std::move(piece));
  }
  if (end) pieces.push_back(end->branch.Piece(parallel_to_m, end_s_m));
  for (const std::optional<WayOut>* way : {&begin, &end}) {
    if (*way) CheckSteepness(own, (*way)->branch, faults);
  }
  if (begin_s_m < end_s_m) made.course = TrackCourse(begin_s_m, end_s_m, std::move(pieces));
  if (begin) made.begin = begin->site;
  if (end) made.end = end->site;
  return made;
}

/// Leads a branch by two arcs to the turnout in which its track ends, and through it.
std::optional<TurnoutSite> LeadToEnd(const TurnoutPlace& place,
                                     std::optional<double> d_m,
                                     BranchCourse& branch,
                                     WorldFaults& faults) {
  const std::optional<WayOut> end = LeaveTurnout(place, d_m, faults);
  if (!end) return std::nullopt;
  const PlanPoint in = end->branch.EndTowardsRising();
  const PlanPoint& from = branch.end();
  const std::optional<Biarc> arcs = from.x_m < in.x_m ? BiarcBetween(from, in) : std::nullopt;
  if (!arcs) {
    faults.Add(place.pointer + "/s_m",
               "must put the end of the turnout ahead of where the track leads to it, at " +
                   MetresText(from.x_m) + " m",
               MetresText(in.x_m) + " m");
    return std::nullopt;
  }
  branch.Add(arcs->first_m, arcs->first_per_m, arcs->first_per_m);
  branch.Add(arcs->second_m, arcs->second_per_m, arcs->second_per_m);
  branch.AddBackwards(end->branch);
  return end->site;
}

/// Tracks with elements, from a turnout on or without one.
IndependentCourse CourseOfElements(const IndependentTrack& own, WorldFaults& faults) {
  ErrorList errors;
  const PiecewiseLinear curvature = CurvatureOf(AlignmentElementsSpec{own.spec.elements}, errors);
  if (!errors.empty()) {
    constexpr std::string_view kCourse = "/course";
    for (const Fault& fault : errors.faults()) {
      faults.Add(own.pointer + fault.place.substr(kCourse.size()), fault.rule, fault.value);
    }
    return {};
  }
  std::optional<WayOut> begin;
  if (own.begin) {
    begin = LeaveTurnout(*own.begin, std::nullopt, faults);
    if (!begin) return {};
  }
  BranchCourse branch =
      begin ? begin->branch
            : BranchCourse(PlanPoint{own.spec.start_s_m, own.spec.offset_m.value_or(0.0),
                                     RadFromDeg(own.spec.heading_deg), 0.0});
  const double begin_s_m = begin ? begin->site.s_m : own.spec.start_s_m;
  for (std::size_t i = 0; i < curvature.pieces().size(); ++i) {
    const LinearPiece& piece = curvature.pieces()[i];
    branch.Add(curvature.EndOf(i) - piece.begin_s_m, piece.begin_value, piece.end_value);
    if (branch.steepest_rad() > kSteepest_rad) break;
  }
  const std::size_t num_faults = faults.errors.size();
  CheckSteepness(own, branch, faults);
  if (faults.errors.size() > num_faults) return {};
  IndependentCourse made;
  if (own.end) {
    made.end = LeadToEnd(*own.end, std::nullopt, branch, faults);
    if (!made.end) return {};
    CheckSteepness(own, branch, faults);
    if (faults.errors.size() > num_faults) return {};
  }
  const double end_s_m = made.end ? made.end->s_m : branch.end_s_m();
  made.course = TrackCourse(begin_s_m, end_s_m, {branch.Piece(begin_s_m, end_s_m)});
  if (begin) made.begin = begin->site;
  return made;
}

/// The track between two turnouts whose places are given.
IndependentCourse CourseBetweenTurnouts(const IndependentTrack& own, WorldFaults& faults) {
  const double from_s_m = *own.begin->spec.s_m;
  const double to_s_m = *own.end->spec.s_m;
  std::optional<WayOut> way =
      LeaveTurnout(*own.begin, own.end->course.OffsetWithin_m(from_s_m), faults);
  if (!way) return {};
  IndependentCourse made;
  made.begin = way->site;
  made.end = LeadToEnd(*own.end, own.begin->course.OffsetWithin_m(to_s_m), way->branch, faults);
  if (!made.end) return {};
  const std::size_t num_faults = faults.errors.size();
  CheckSteepness(own, way->branch, faults);
  if (faults.errors.size() > num_faults) return {};
  made.course = TrackCourse(from_s_m, to_s_m, {way->branch.Piece(from_s_m, to_s_m)});
  return made;
}

/// The track between two turnouts that face each other.
IndependentCourse CourseOfCrossover(const IndependentTrack& own, WorldFaults& faults) {
  const TurnoutPlace& from = *own.begin;
  const TurnoutPlace& to = *own.end;
  double to_d_m = to.course.OffsetAt(*from.spec.s_m).d_m;
  std::optional<WayOut> way = LeaveTurnout(from, to_d_m, faults);
  if (!way) return {};
  const double side = to_d_m > from.course.OffsetAt(*from.spec.s_m).d_m ? 1.0 : -1.0;
  const TurnoutGeometry& geometry = to.geometry;
  constexpr double kSameAngle_rad = 1e-6;
  if (std::abs(way->branch.end().heading_rad - side * geometry.angle_rad) > kSameAngle_rad) {
    faults.Add(to.pointer + "/turnout",
               "must have the angle that the turnout at the beginning leads to, " +
                   ShortText(DegFromRad(std::abs(way->branch.end().heading_rad))) +
                   " degrees against track " + Quoted(to.spec.track),
               std::string(NameOf(to.spec.turnout)));
    return {};
  }
  const PlanPoint leave = way->branch.end();
  const double behind_m = geometry.length_m - geometry.tangent_m;
  const double rise_m = behind_m * std::sin(geometry.angle_rad);
  double straight_m = 0.0;
  double end_s_m = leave.x_m;
  // Where the other track's offset changes, it is the one at the end that counts.
  constexpr int kNumSteps = 4;
  for (int step = 0; step < kNumSteps; ++step) {
    straight_m = (side * (to_d_m - leave.y_m) - rise_m) / std::sin(std::abs(leave.heading_rad));
    end_s_m = leave.x_m + straight_m * std::cos(leave.heading_rad) +
              behind_m * std::cos(geometry.angle_rad) + geometry.tangent_m;
    to_d_m = to.course.OffsetAt(end_s_m).d_m;
  }
  if (straight_m < -kRounding_m) {
    const double main_d_m = from.course.OffsetAt(*from.spec.s_m).d_m;
    faults.Add(
        own.pointer,
        "must join tracks that are at least " +
            MetresText(std::abs(to_d_m - main_d_m) - straight_m * std::sin(geometry.angle_rad)) +
            " m apart, for both turnouts to fit between them",
        MetresText(std::abs(to_d_m - main_d_m)));
    return {};
  }
  if (!CurvatureThrough(to, end_s_m, faults)) return {};
  if (to.course.OffsetAt(end_s_m).slope != 0.0 ||
      to.course.OffsetAt(TurnoutEnd_m(to, end_s_m)).d_m != to_d_m) {
    faults.Add(to.pointer, "must lie where track " + Quoted(to.spec.track) +
                               " is parallel to the alignment (got " + MetresText(end_s_m) + " m)");
    return {};
  }
  way->branch.Add(straight_m, 0.0, 0.0);
  way->branch.AddTurnoutBackwards(geometry, -side, 0.0);
  IndependentCourse made;
  made.course = TrackCourse(*from.spec.s_m, end_s_m, {way->branch.Piece(*from.spec.s_m, end_s_m)});
  made.begin = way->site;
  made.end = SiteOf(to, end_s_m, side > 0.0 ? TrackSide::kRight : TrackSide::kLeft);
  return made;
}

}  // namespace

IndependentCourse MakeIndependentCourse(const IndependentTrack& own, WorldFaults& faults) {
  const std::size_t num_faults = faults.errors.size();
  CheckKeys(own, faults);
  if (faults.errors.size() > num_faults) return {};
  IndependentCourse made;
  if (IsCrossover(own.spec)) {
    made = own.end->spec.s_m ? CourseBetweenTurnouts(own, faults) : CourseOfCrossover(own, faults);
  } else {
    made = own.spec.elements.empty() ? CourseOfOffsets(own, faults) : CourseOfElements(own, faults);
  }
  if (!made.course) return made;
  const double begin_s_m = made.course->begin_s_m();
  const double end_s_m = made.course->end_s_m();
  if (!(begin_s_m >= 0.0 && end_s_m <= own.line_length_m + kRounding_m)) {
    faults.Add(own.pointer, "must lie on the line, " + StretchText(0.0, own.line_length_m),
               StretchText(begin_s_m, end_s_m));
    return {};
  }
  return made;
}

}  // namespace railcast
