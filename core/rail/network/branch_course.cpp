#include "core/rail/network/branch_course.h"

#include <algorithm>
#include <cmath>
#include <memory>

namespace railcast {
namespace {

/// Shorter elements are rounding residues.
constexpr double kShortest_m = 1e-9;

PlanPoint PointOn(const TrackCourse& track, double s_m, bool is_mirrored) {
  const TrackOffset offset = track.OffsetAt(s_m);
  const double side = is_mirrored ? -1.0 : 1.0;
  return {side * s_m, offset.d_m, std::atan(side * offset.slope), 0.0};
}

}  // namespace

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
