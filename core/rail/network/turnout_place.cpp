#include "core/rail/network/turnout_place.h"

#include <algorithm>
#include <cmath>
#include <memory>
#include <numeric>

#include "core/base/error.h"
#include "core/base/join.h"
#include "core/base/text.h"
#include "core/rail/network/network.h"

namespace railcast {
namespace {

/// A turnout that ends where its arc does.
TurnoutGeometry ArcToTheEnd(double radius_m, double run) {
  const double angle_rad = std::atan(1.0 / run);
  const double tangent_m = radius_m * std::tan(0.5 * angle_rad);
  return {radius_m, angle_rad, tangent_m, 2.0 * tangent_m};
}

/// Shorter elements are rounding residues.
constexpr double kShortest_m = 1e-9;

PlanPoint PointOn(const TrackCourse& track, double s_m, bool is_mirrored) {
  const TrackOffset offset = track.OffsetAt(s_m);
  const double side = is_mirrored ? -1.0 : 1.0;
  return {side * s_m, offset.d_m, std::atan(side * offset.slope), 0.0};
}

}  // namespace

std::optional<double> ClearChainage_m(const TrackCourse& track,
                                      const TrackCourse& branch,
                                      const TurnoutSite& turnout,
                                      double distance_m) {
  const auto is_clear = [&](double s_m) {
    return std::abs(branch.OffsetAt(s_m).d_m - track.OffsetAt(s_m).d_m) >= distance_m - 1e-9;
  };
  constexpr double kStep_m = 1.0;
  constexpr double kFarthest_m = 1000.0;
  constexpr double kExact_m = 1e-6;
  const double side = turnout.opens_ahead() ? kStep_m : -kStep_m;
  double before_m = turnout.s_m;
  double after_m = turnout.s_m;
  do {
    before_m = after_m;
    after_m += side;
    const bool is_on_both = std::clamp(after_m, branch.begin_s_m(), branch.end_s_m()) == after_m &&
                            std::clamp(after_m, track.begin_s_m(), track.end_s_m()) == after_m;
    if (!is_on_both || std::abs(after_m - turnout.s_m) > kFarthest_m) return std::nullopt;
  } while (!is_clear(after_m));
  while (std::abs(after_m - before_m) > kExact_m) {
    const double middle_m = std::midpoint(before_m, after_m);
    (is_clear(middle_m) ? after_m : before_m) = middle_m;
  }
  return after_m;
}

TurnoutGeometry GeometryOf(TurnoutType type) {
  switch (type) {
    case TurnoutType::k9_190: {
      TurnoutGeometry geometry = ArcToTheEnd(190.0, 9.0);
      geometry.length_m = geometry.tangent_m + ArcToTheEnd(300.0, 9.0).tangent_m;
      return geometry;
    }
    case TurnoutType::k9_300:
      return ArcToTheEnd(300.0, 9.0);
    case TurnoutType::k12_500:
      return ArcToTheEnd(500.0, 12.0);
    case TurnoutType::k14_760:
      return ArcToTheEnd(760.0, 14.0);
  }
  Check(false, "the type is one of the enumeration");
  return {};
}

double TurnoutEnd_m(const TurnoutPlace& place, double s_m) {
  const double side = place.opens_ahead ? 1.0 : -1.0;
  // From its middle on, where the curvature is that inside the turnout.
  const double middle_s_m = s_m + side * 0.5 * place.geometry.length_m;
  const double per_m = place.course.OffsetAt(middle_s_m).curvature_per_m();
  BranchCourse main(place.course, s_m, !place.opens_ahead);
  main.Add(place.geometry.length_m, per_m, per_m);
  return main.end_s_m();
}

std::optional<std::vector<LinearPiece>> CurvatureThrough(const TurnoutPlace& place,
                                                         double s_m,
                                                         WorldFaults& faults) {
  constexpr int kNumSamples = 64;
  constexpr double kSameCurvature_per_m = 1e-7;
  constexpr double kSamePlace_m = 1e-3;
  const double end_s_m = TurnoutEnd_m(place, s_m);
  const auto [least_m, most_m] = std::minmax(s_m, end_s_m);
  const std::string chainage = place.pointer + "/s_m";
  const std::string name = Quoted(place.spec.track);
  if (least_m < place.course.begin_s_m() - kSamePlace_m ||
      most_m > place.course.end_s_m() + kSamePlace_m) {
    faults.Add(chainage,
               "must put the turnout on track " + name + ", " +
                   StretchText(place.course.begin_s_m(), place.course.end_s_m()),
               StretchText(least_m, most_m));
    return std::nullopt;
  }
  double least_per_m = 1e9;
  double most_per_m = -1e9;
  for (int i = 0; i < kNumSamples; ++i) {
    const double at_m = std::lerp(least_m, most_m, (i + 0.5) / kNumSamples);
    const double per_m = place.course.OffsetAt(at_m).curvature_per_m();
    least_per_m = std::min(least_per_m, per_m);
    most_per_m = std::max(most_per_m, per_m);
  }
  if (most_per_m - least_per_m <= kSameCurvature_per_m) {
    const double per_m = 0.5 * (least_per_m + most_per_m);
    return std::vector<LinearPiece>{{0.0, per_m, per_m}};
  }
  std::vector<LinearPiece> pieces;
  const auto curvature_per_m = [&](int sample) {
    return place.course.OffsetAt(std::lerp(s_m, end_s_m, 1.0 * sample / kNumSamples))
        .curvature_per_m();
  };
  for (int i = 0; i < kNumSamples; ++i) {
    pieces.push_back(
        {place.geometry.length_m * i / kNumSamples, curvature_per_m(i), curvature_per_m(i + 1)});
  }
  return pieces;
}

bool AreNamesKnown(const WorldSpec& world, const WorldFaults& faults) {
  for (std::size_t i = 0; i < world.tracks.size(); ++i) {
    if (!faults.AreKnown({TrackPointer(i) + "/name"})) return false;
  }
  return true;
}

void AddUnknownTrack(const WorldSpec& world,
                     const std::string& pointer,
                     const std::string& name,
                     WorldFaults& faults) {
  if (!AreNamesKnown(world, faults)) return;
  const auto quoted = [](const TrackSpec& track) { return Quoted(track.name); };
  faults.Add(pointer,
             "must be one of " + Join(world.tracks, ", ", quoted) + " (got " + Quoted(name) + ")");
}

std::string MetresText(double length_m) {
  return NumberText(std::round(length_m * 1e3) / 1e3);
}

std::string StretchText(double begin_s_m, double end_s_m) {
  return "from " + MetresText(begin_s_m) +
         (std::isinf(end_s_m) ? " m on" : " to " + MetresText(end_s_m) + " m");
}

BranchCourse::BranchCourse(const TrackCourse& track, double s_m, bool is_mirrored)
    : start_(PointOn(track, s_m, is_mirrored)), end_(start_), is_mirrored_(is_mirrored) {}

BranchCourse::BranchCourse(const PlanPoint& start)
    : start_(start), end_(start), is_mirrored_(false), steepest_rad_(std::abs(start.heading_rad)) {}

void BranchCourse::AddTurnout(const TurnoutGeometry& turnout,
                              double side,
                              const std::vector<LinearPiece>& through) {
  const double diverging_per_m = side / turnout.radius_m;
  if (through.size() == 1) {
    const double main_per_m = through.front().begin_value;
    Add(turnout.arc_m(), main_per_m + diverging_per_m, main_per_m + diverging_per_m);
    Add(turnout.straight_m(), main_per_m, main_per_m);
    return;
  }
  const double arc_m = turnout.arc_m();
  const double length_m = arc_m + turnout.straight_m();
  for (std::size_t i = 0; i < through.size(); ++i) {
    const LinearPiece& piece = through[i];
    const bool is_last = i + 1 == through.size();
    const double end_m = is_last ? length_m : std::min(through[i + 1].begin_s_m, length_m);
    const auto value_per_m = [&](double at_m) {
      return std::lerp(piece.begin_value, piece.end_value,
                       (at_m - piece.begin_s_m) / (end_m - piece.begin_s_m));
    };
    if (!(end_m > piece.begin_s_m)) break;
    const double bent_to_m = std::clamp(arc_m, piece.begin_s_m, end_m);
    Add(bent_to_m - piece.begin_s_m, piece.begin_value + diverging_per_m,
        value_per_m(bent_to_m) + diverging_per_m);
    Add(end_m - bent_to_m, value_per_m(bent_to_m), piece.end_value);
  }
}

void BranchCourse::AddBackwards(const BranchCourse& way_out) {
  for (std::size_t i = way_out.curvature_.size(); i-- > 0;) {
    const LinearPiece& piece = way_out.curvature_[i];
    const bool is_last = i + 1 == way_out.curvature_.size();
    const double end_m = is_last ? way_out.length_m_ : way_out.curvature_[i + 1].begin_s_m;
    // Running back turns a course's curvature round; so does a mirrored plane, whose curvature is
    // that of the plane in which this course lies.
    const double side = way_out.is_mirrored_ == is_mirrored_ ? -1.0 : 1.0;
    Add(end_m - piece.begin_s_m, side * piece.end_value, side * piece.begin_value);
  }
}

void BranchCourse::AddTurnoutBackwards(const TurnoutGeometry& turnout,
                                       double side,
                                       double main_per_m) {
  const double diverging_per_m = main_per_m + side / turnout.radius_m;
  Add(turnout.straight_m(), main_per_m, main_per_m);
  Add(turnout.arc_m(), diverging_per_m, diverging_per_m);
}

void BranchCourse::Add(double length_m, double begin_per_m, double end_per_m) {
  if (!(length_m > kShortest_m)) return;
  constexpr int kNumSamples = 8;
  const double slope_per_m2 = (end_per_m - begin_per_m) / length_m;
  for (int i = 0; i <= kNumSamples; ++i) {
    const double inside_m = length_m * i / kNumSamples;
    steepest_rad_ = std::max(steepest_rad_, std::abs(end_.heading_rad + begin_per_m * inside_m +
                                                     0.5 * slope_per_m2 * inside_m * inside_m));
  }
  curvature_.push_back({length_m_, begin_per_m, end_per_m});
  const PlanCourse element(PiecewiseLinear({{0.0, begin_per_m, end_per_m}}, length_m), end_);
  end_ = element.At(length_m);
  length_m_ += length_m;
}

std::optional<double> BranchCourse::AddReturnTo(double d_m, double radius_m) {
  constexpr double kLevel_rad = 1e-9;
  constexpr double kSameOffset_m = 1e-3;
  const double angle_rad = end_.heading_rad;
  if (std::abs(angle_rad) < kLevel_rad) {
    return std::abs(end_.y_m - d_m) < kSameOffset_m ? std::nullopt : std::optional(end_.y_m);
  }
  const double side = std::copysign(1.0, angle_rad);
  const double least_d_m = end_.y_m + side * radius_m * (1.0 - std::cos(angle_rad));
  const double straight_m = (d_m - least_d_m) / std::sin(angle_rad);
  if (straight_m < -kSameOffset_m) return least_d_m;
  Add(straight_m, 0.0, 0.0);
  Add(radius_m * std::abs(angle_rad), -side / radius_m, -side / radius_m);
  return std::nullopt;
}

CoursePiece BranchCourse::Piece(double begin_s_m, double end_s_m) const {
  return {
      .kind = CoursePiece::Kind::kPlan,
      .begin_s_m = begin_s_m,
      .end_s_m = end_s_m,
      .plan = std::make_shared<const PlanCourse>(PiecewiseLinear(curvature_, length_m_), start_),
      .plan_begin_x_m = start_.x_m,
      .plan_length_m = length_m_,
      .is_mirrored = is_mirrored_};
}

}  // namespace railcast
