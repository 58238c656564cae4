#include "core/rail/world/own_track.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <utility>

namespace railcast {
namespace {

/// At most, of chainage. A curvature that changes by 1 / 190 m at the toe of a turnout, where the
/// interpolation errs most, then moves the track by less than 1 mm.
constexpr double kAxisStep_m = 1.0;
/// Boxes are cut into pieces of this length; within one the track leaves its tangent by at most
/// 1 m^2 / (2 R): 5 mm at R = 100 m.
constexpr double kPiece_m = 2.0;
constexpr double kMaxPieces = 64.0;

/// Number of pieces that a length is cut into.
int PiecesOf(double length_m) {
  return static_cast<int>(std::clamp(std::ceil(length_m / kPiece_m), 1.0, kMaxPieces));
}

}  // namespace

OwnTrack::OwnTrack(const RailWorld& world,
                   const CatenarySpec& catenary,
                   std::vector<GaugePart> gauge)
    : alignment_(world.alignment()), track_(world.vehicle_course()), gauge_(std::move(gauge)) {
  if (gauge_.empty()) {
    gauge_ = VehicleOutline(ContactHeightOver_m(world.vehicle_track(), catenary));
  }
  const double length_m = end_s_m() - begin_s_m();
  const auto num_steps = static_cast<std::size_t>(std::max(std::ceil(length_m / kAxisStep_m), 1.0));
  step_m_ = length_m / static_cast<double>(num_steps);
  for (std::size_t i = 0; i <= num_steps; ++i) {
    const Transform world_from_track = WorldFromTrack(ChainageOf_m(i));
    axis_m_.emplace_back(world_from_track.translation());
    world_from_track_.emplace_back(world_from_track.linear());
    if (i == 0) continue;
    longest_step_m_ = std::max(longest_step_m_, (axis_m_[i] - axis_m_[i - 1]).norm());
  }
}

// Goes outwards from the beginning of the search. From a point of the axis that is farther away
// than the nearest one known, none can be nearer for as many steps as the difference is long.
std::size_t OwnTrack::NearestTo(const Vector3& world_m, double near_s_m) const {
  // Within so few metres there is one nearest point, which is then found step by step.
  constexpr double kStride = 8.0;
  const auto last = static_cast<std::ptrdiff_t>(axis_m_.size()) - 1;
  const auto distance_m = [&](std::ptrdiff_t i) {
    return (axis_m_[static_cast<std::size_t>(i)] - world_m).norm();
  };
  const double share = std::clamp((near_s_m - begin_s_m()) / step_m_, 0.0, double(last));
  const auto first = static_cast<std::ptrdiff_t>(share);
  std::ptrdiff_t best = first;
  double best_m = distance_m(first);
  for (const std::ptrdiff_t way : {1, -1}) {
    double here_m = best_m;
    for (std::ptrdiff_t i = first;;) {
      const double spare = std::max(kStride, (here_m - best_m) / longest_step_m_);
      const std::ptrdiff_t left = way > 0 ? last - i : i;
      if (left == 0) break;
      i += way * std::min(left, static_cast<std::ptrdiff_t>(std::min(spare, double(left))));
      here_m = distance_m(i);
      if (here_m >= best_m) continue;
      best = i;
      best_m = here_m;
    }
  }
  for (const std::ptrdiff_t way : {1, -1}) {
    while (best + way >= 0 && best + way <= last) {
      const double here_m = distance_m(best + way);
      if (here_m >= best_m) break;
      best += way;
      best_m = here_m;
    }
  }
  return static_cast<std::size_t>(best);
}

std::optional<PlaceByTrack> OwnTrack::PlaceOf(const Vector3& world_m, double near_s_m) const {
  const auto seen_from = [&](std::size_t i) -> Vector3 {
    return world_from_track_[i].transpose() * (world_m - axis_m_[i]);
  };
  std::size_t i = NearestTo(world_m, near_s_m);
  Vector3 before_m = seen_from(i);
  const bool is_before = before_m.x() < 0.0;
  if (is_before ? i == 0 : i + 1 == axis_m_.size()) return std::nullopt;
  if (is_before) before_m = seen_from(--i);
  const Vector3 after_m = seen_from(i + 1);
  // Beside a curve, a metre of the axis is longer or shorter.
  const double way_m = before_m.x() - after_m.x();
  if (!(way_m > 0.0)) return std::nullopt;
  const double share = before_m.x() / way_m;
  // y'' = k F / h, where k is the curvature and F the way beside the axis that belongs to its step
  // h: from dy/ds = (p - o) . dy/ds and d(p - o) . x / ds = -F / h.
  const Vector3 bend = world_from_track_[i].transpose() * world_from_track_[i + 1].col(0);
  const Vector3 place_m =
      before_m + share * (after_m - before_m) - 0.5 * way_m * share * (1.0 - share) * bend;
  return PlaceByTrack{.chainage_m = ChainageOf_m(i) + share * step_m_,
                      .lateral_m = place_m.y(),
                      .height_m = place_m.z()};
}

bool OwnTrack::IsInGauge(const PlaceByTrack& place) const {
  return IsInside(gauge_, place.lateral_m, place.height_m);
}

double OwnTrack::ChainageNear_m(const Vector3& world_m) const {
  return Refined_m(ChainageOf_m(NearestTo(world_m, begin_s_m())), world_m);
}

// Newton's method.
double OwnTrack::Refined_m(double s_m, const Vector3& world_m) const {
  constexpr int kNumSteps = 3;
  for (int i = 0; i < kNumSteps; ++i) {
    s_m += (track_.WorldFromTrack(alignment_, s_m).inverse() * world_m).x();
  }
  return s_m;
}

GaugeClearance OwnTrack::ClearanceAhead(const Transform& world_from_vehicle,
                                        const Transform& world_from_box,
                                        const Vector3& size_m) const {
  const double vehicle_s_m = ChainageNear_m(world_from_vehicle.translation());
  const bool is_along = track_.WorldFromTrack(alignment_, vehicle_s_m)
                            .linear()
                            .col(0)
                            .dot(world_from_vehicle.linear().col(0)) > 0.0;
  GaugeClearance nearest{.is_inside = false,
                         .from_axis_m = std::numeric_limits<double>::infinity()};
  const double box_s_m = ChainageNear_m(world_from_box.translation());
  // The height is not cut, since the vertical curvature of a track is small.
  const int num_x = PiecesOf(size_m.x());
  const int num_y = PiecesOf(size_m.y());
  const Vector3 piece_m(size_m.x() / num_x, size_m.y() / num_y, size_m.z());
  for (int i = 0; i < num_x * num_y; ++i) {
    const int across = i / num_x;
    const Vector3 center_m(piece_m.x() * (i % num_x + 0.5) - 0.5 * size_m.x(),
                           piece_m.y() * (across + 0.5) - 0.5 * size_m.y(), 0.0);
    Transform world_from_piece = world_from_box;
    world_from_piece.translate(center_m);
    const double s_m = Refined_m(box_s_m, world_from_piece.translation());
    const bool is_ahead = is_along ? s_m > vehicle_s_m : s_m < vehicle_s_m;
    if (!is_ahead || s_m < track_.begin_s_m() || s_m > track_.end_s_m()) continue;
    const GaugeClearance piece = ClearanceOf(
        gauge_, track_.WorldFromTrack(alignment_, s_m).inverse() * world_from_piece, piece_m);
    nearest.is_inside = nearest.is_inside || piece.is_inside;
    nearest.from_axis_m = std::min(nearest.from_axis_m, piece.from_axis_m);
  }
  return nearest;
}

}  // namespace railcast
