#include "core/rail/line/track_course.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <iterator>
#include <utility>

#include "core/base/error.h"
#include "core/rail/line/plan_course.h"

namespace railcast {
namespace {

/// d = d_0 + (d_1 - d_0) (10 t^3 - 15 t^4 + 6 t^5), whose first two derivatives are 0 at both ends.
TrackOffset OnSCurve(const CoursePiece& piece, double s_m) {
  const double length_m = piece.end_s_m - piece.begin_s_m;
  const double rise_m = piece.end_d_m - piece.begin_d_m;
  const double t = (s_m - piece.begin_s_m) / length_m;
  return {piece.begin_d_m + rise_m * t * t * t * (10.0 + t * (-15.0 + 6.0 * t)),
          rise_m / length_m * 30.0 * t * t * (1.0 - t) * (1.0 - t),
          rise_m / (length_m * length_m) * 60.0 * t * (1.0 - t) * (1.0 - 2.0 * t)};
}

/// How much of a plane's height counts, from 1 to 0 with no slope and no curvature at its ends.
TrackLift ShareOf(const SharedPlane& plane, double s_m) {
  const double length_m = plane.none_s_m - plane.whole_s_m;
  const double t = (s_m - plane.whole_s_m) / length_m;
  if (t <= 0.0) return {1.0, 0.0};
  if (t >= 1.0) return {0.0, 0.0};
  return {1.0 - t * t * t * (10.0 + t * (-15.0 + 6.0 * t)),
          -30.0 * t * t * (1.0 - t) * (1.0 - t) / length_m};
}

/// The height of a place at the offset `own` in the canted plane of a track. The gradient's
/// influence on the plane's cross slope is neglected: less than its square times the height.
TrackLift HeightInPlaneOf(const TrackCourse& track,
                          const Alignment& alignment,
                          double s_m,
                          const TrackOffset& own) {
  const AxisPoint axis = alignment.At(s_m);
  const TrackOffset of_track = track.OffsetAt(s_m);
  const double turn_rad = TurnFromAlignment_rad(axis, of_track);
  const double apart_m = own.d_m - of_track.d_m;
  // The place lies square to the track at this chainage.
  const double foot_per_apart = std::sin(turn_rad) * std::cos(turn_rad);
  const TrackLift at_foot = track.LiftAt(alignment, s_m + apart_m * foot_per_apart);
  const double cross_slope = std::cos(turn_rad) * std::tan(axis.cant_rad);
  const double parting = own.slope - of_track.slope;
  return {at_foot.h_m + apart_m * cross_slope,
          at_foot.slope * (1.0 + parting * foot_per_apart) + parting * cross_slope};
}

/// Newton's method for the length at which the plan course has the given x. Headings are below 45
/// degrees, so it converges.
PlanPoint PointAtX(const CoursePiece& piece, double x_m) {
  constexpr int kMostSteps = 20;
  constexpr double kExact_m = 1e-11;
  double along_m = std::clamp(x_m - piece.plan_begin_x_m, 0.0, piece.plan_length_m);
  PlanPoint point = piece.plan->At(along_m);
  for (int step = 0; step < kMostSteps && std::abs(x_m - point.x_m) > kExact_m; ++step) {
    const double next_m = std::clamp(along_m + (x_m - point.x_m) / std::cos(point.heading_rad), 0.0,
                                     piece.plan_length_m);
    if (next_m == along_m) break;
    along_m = next_m;
    point = piece.plan->At(along_m);
  }
  // Straight on beyond either end.
  point.y_m += (x_m - point.x_m) * std::tan(point.heading_rad);
  return point;
}

TrackOffset OnPlan(const CoursePiece& piece, double s_m) {
  const double side = piece.is_mirrored ? -1.0 : 1.0;
  const PlanPoint point = PointAtX(piece, side * s_m);
  const double slope = std::tan(point.heading_rad);
  return {point.y_m, side * slope, point.curvature_per_m * std::pow(1.0 + slope * slope, 1.5)};
}

TrackOffset OnPiece(const CoursePiece& piece, double s_m) {
  switch (piece.kind) {
    case CoursePiece::Kind::kLevel:
      return {piece.begin_d_m, 0.0, 0.0};
    case CoursePiece::Kind::kSCurve:
      return OnSCurve(piece, s_m);
    case CoursePiece::Kind::kPlan:
      return OnPlan(piece, s_m);
  }
  return {};
}

}  // namespace

double TrackOffset::curvature_per_m() const {
  return bend_per_m / std::pow(1.0 + slope * slope, 1.5);
}

double TurnFromAlignment_rad(const AxisPoint& axis, const TrackOffset& offset) {
  if (offset.slope == 0.0) return 0.0;
  return std::atan(offset.slope / (1.0 - axis.curvature_per_m * offset.d_m));
}

TrackCourse::TrackCourse(double begin_s_m, double end_s_m, double offset_m)
    : TrackCourse(begin_s_m,
                  end_s_m,
                  {CoursePiece{.kind = CoursePiece::Kind::kLevel,
                               .begin_s_m = begin_s_m,
                               .end_s_m = end_s_m,
                               .begin_d_m = offset_m,
                               .end_d_m = offset_m,
                               .plan = nullptr}}) {}

TrackCourse::TrackCourse(double begin_s_m, double end_s_m, std::vector<CoursePiece> pieces)
    : begin_s_m_(begin_s_m),
      end_s_m_(end_s_m),
      pieces_(std::make_shared<const std::vector<CoursePiece>>(std::move(pieces))) {
  Check(!pieces_->empty(), "a course has a piece");
  if (!is_parallel()) {
    at_begin_ = OnPiece(PieceAt(begin_s_m_), begin_s_m_);
    at_end_ = OnPiece(PieceAt(end_s_m_), end_s_m_);
  }
  constexpr double kSampling_m = 1.0;
  least_d_m_ = most_d_m_ = OffsetAt(begin_s_m_).d_m;
  const auto add = [&](double s_m) {
    const double d_m = OffsetWithin_m(s_m);
    least_d_m_ = std::min(least_d_m_, d_m);
    most_d_m_ = std::max(most_d_m_, d_m);
  };
  for (const CoursePiece& piece : *pieces_) {
    const double from_s_m = std::max(piece.begin_s_m, begin_s_m_);
    const double to_s_m = std::min(piece.end_s_m, end_s_m_);
    add(from_s_m);
    if (piece.kind == CoursePiece::Kind::kLevel) continue;
    for (double s_m = from_s_m + kSampling_m; s_m < to_s_m; s_m += kSampling_m) add(s_m);
    add(to_s_m);
  }
}

bool TrackCourse::is_parallel() const {
  return pieces_->size() == 1 && pieces_->front().kind == CoursePiece::Kind::kLevel;
}

bool TrackCourse::IsLevelIn(double from_s_m, double to_s_m) const {
  const double from_m = std::clamp(from_s_m, begin_s_m_, end_s_m_);
  const double to_m = std::clamp(to_s_m, begin_s_m_, end_s_m_);
  const double d_m = OffsetAt(from_m).d_m;
  return std::all_of(pieces_->begin(), pieces_->end(), [&](const CoursePiece& piece) {
    const bool is_outside = piece.end_s_m <= from_m || piece.begin_s_m >= to_m;
    return is_outside || (piece.kind == CoursePiece::Kind::kLevel && piece.begin_d_m == d_m);
  });
}

const CoursePiece& TrackCourse::PieceAt(double s_m) const {
  const auto after =
      std::upper_bound(pieces_->begin() + 1, pieces_->end(), s_m,
                       [](double s, const CoursePiece& p) { return s < p.begin_s_m; });
  return *(after - 1);
}

TrackOffset TrackCourse::OffsetAt(double s_m) const {
  if (is_parallel()) return OnPiece(pieces_->front(), s_m);
  const double inside_s_m = std::clamp(s_m, begin_s_m_, end_s_m_);
  // Many places lie beside the end of some track.
  const bool is_at_end = inside_s_m == end_s_m_;
  if (!is_at_end && inside_s_m != begin_s_m_) return OnPiece(PieceAt(inside_s_m), inside_s_m);
  TrackOffset offset = is_at_end ? at_end_ : at_begin_;
  if (s_m != inside_s_m) {
    offset.d_m += offset.slope * (s_m - inside_s_m);
    offset.bend_per_m = 0.0;
  }
  return offset;
}

double TrackCourse::OffsetWithin_m(double s_m) const {
  return OffsetAt(std::clamp(s_m, begin_s_m_, end_s_m_)).d_m;
}

double CurvatureBeside_per_m(double axis_per_m, const TrackOffset& offset) {
  // With the offset d(s) from an axis of curvature k, the axis of the track has the velocity
  // (u, v) = (1 - k d, d') in the frame of the alignment, and the acceleration (-2 k d', d'' + k
  // u).
  const double u = 1.0 - axis_per_m * offset.d_m;
  const double v = offset.slope;
  return (u * (offset.bend_per_m + axis_per_m * u) + 2.0 * axis_per_m * v * v) /
         std::pow(u * u + v * v, 1.5);
}

double TrackCourse::CurvatureAt(const Alignment& alignment, double s_m) const {
  return CurvatureBeside_per_m(alignment.At(s_m).curvature_per_m, OffsetAt(s_m));
}

double TrackCourse::Heading_rad(const Alignment& alignment, double s_m) const {
  const AxisPoint axis = alignment.At(s_m);
  return axis.heading_rad + TurnFromAlignment_rad(axis, OffsetAt(s_m));
}

TrackLift TrackCourse::LiftAt(const Alignment& alignment, double s_m) const {
  TrackLift lift;
  const CoursePiece& piece = PieceAt(std::clamp(s_m, begin_s_m_, end_s_m_));
  if (piece.planes == nullptr) return lift;
  for (const SharedPlane& plane : *piece.planes) {
    const TrackLift share = ShareOf(plane, s_m);
    if (share.h_m == 0.0) continue;
    const TrackLift whole = HeightInPlaneOf(plane.track, alignment, s_m, OffsetAt(s_m));
    lift.h_m += share.h_m * whole.h_m;
    lift.slope += share.h_m * whole.slope + share.slope * whole.h_m;
  }
  return lift;
}

TrackCourse TrackCourse::InPlanes(std::vector<SharedPlane> planes) const {
  const auto shared = std::make_shared<const std::vector<SharedPlane>>(std::move(planes));
  std::vector<CoursePiece> pieces = *pieces_;
  for (CoursePiece& piece : pieces) piece.planes = shared;
  TrackCourse course = *this;
  course.pieces_ = std::make_shared<const std::vector<CoursePiece>>(std::move(pieces));
  return course;
}

Transform TrackCourse::WorldFromTrack(const Alignment& alignment,
                                      double s_m,
                                      double d_m,
                                      double h_m) const {
  const TrackOffset offset = OffsetAt(s_m);
  const TrackLift lift = LiftAt(alignment, s_m);
  if (offset.slope == 0.0 && lift.h_m == 0.0 && lift.slope == 0.0) {
    return alignment.WorldFromTrack(s_m, offset.d_m + d_m, h_m);
  }
  AxisPoint axis = alignment.At(s_m);
  axis.position_m.z() += lift.h_m;
  axis.gradient += lift.slope;
  const double turn_rad = TurnFromAlignment_rad(axis, offset);
  const double heading_rad = axis.heading_rad + turn_rad;
  const Eigen::Matrix3d world_from_track = RotationFromYawPitchRoll(
      heading_rad, -std::atan(axis.gradient * std::cos(turn_rad)), axis.cant_rad);
  const Vector3 left_of_axis(-std::sin(axis.heading_rad), std::cos(axis.heading_rad), 0.0);
  const Vector3 left(-std::sin(heading_rad), std::cos(heading_rad), 0.0);
  return MakeTransform(world_from_track, axis.position_m + offset.d_m * left_of_axis + d_m * left +
                                             h_m * world_from_track.col(2));
}

TrackCourse Joined(const TrackCourse& before, const TrackCourse& after, double s_m) {
  std::vector<CoursePiece> pieces;
  for (const CoursePiece& piece : before.pieces()) {
    if (piece.begin_s_m < s_m) pieces.push_back(piece);
  }
  if (!pieces.empty()) pieces.back().end_s_m = s_m;
  bool is_first = true;
  for (const CoursePiece& piece : after.pieces()) {
    if (piece.end_s_m <= s_m && &piece != &after.pieces().back()) continue;
    pieces.push_back(piece);
    if (is_first) pieces.back().begin_s_m = s_m;
    is_first = false;
  }
  return {before.begin_s_m(), after.end_s_m(), std::move(pieces)};
}

TrackLength::TrackLength(const Alignment& alignment, const TrackCourse& course)
    : TrackLength(alignment, course, course.begin_s_m(), course.end_s_m()) {}

TrackLength::TrackLength(const Alignment& alignment,
                         const TrackCourse& course,
                         double begin_s_m,
                         double end_s_m)
    : begin_s_m_(begin_s_m) {
  constexpr double kSampling_m = 1.0;
  const double extent_m = end_s_m - begin_s_m;
  const auto num_steps = static_cast<std::size_t>(std::max(1.0, std::ceil(extent_m / kSampling_m)));
  step_m_ = extent_m / static_cast<double>(num_steps);
  lengths_m_.push_back(0.0);
  const auto axis_at = [&](std::size_t i) -> Vector3 {
    const double s_m = begin_s_m_ + step_m_ * static_cast<double>(i);
    return course.WorldFromTrack(alignment, s_m).translation();
  };
  Vector3 before_m = axis_at(0);
  for (std::size_t i = 1; i <= num_steps; ++i) {
    const Vector3 here_m = axis_at(i);
    lengths_m_.push_back(lengths_m_.back() + (here_m - before_m).norm());
    before_m = here_m;
  }
}

double TrackLength::UpTo(double s_m) const {
  const double from_begin_m = s_m - begin_s_m_;
  const double num_steps = static_cast<double>(lengths_m_.size() - 1);
  const double step = from_begin_m / step_m_;
  if (step <= 0.0) return from_begin_m;
  if (step >= num_steps) return total_m() + from_begin_m - num_steps * step_m_;
  const auto cell = static_cast<std::size_t>(step);
  return std::lerp(lengths_m_[cell], lengths_m_[cell + 1], step - static_cast<double>(cell));
}

double TrackLength::MovedFrom(double s_m, double length_m) const {
  const double to_m = UpTo(s_m) + length_m;
  if (to_m <= 0.0) return begin_s_m_ + to_m;
  const double num_steps = static_cast<double>(lengths_m_.size() - 1);
  if (to_m >= total_m()) return begin_s_m_ + num_steps * step_m_ + to_m - total_m();
  const auto after = std::upper_bound(lengths_m_.begin(), lengths_m_.end(), to_m);
  const double cell = static_cast<double>(std::distance(lengths_m_.begin(), after) - 1);
  const double share = (to_m - *(after - 1)) / (*after - *(after - 1));
  return begin_s_m_ + step_m_ * (cell + share);
}

}  // namespace railcast
