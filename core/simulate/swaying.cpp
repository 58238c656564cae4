#include "core/simulate/swaying.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "core/scene/shapes.h"
#include "core/simulate/wind.h"

namespace railcast {
namespace {

constexpr double kTreeStep_s = 0.1;
constexpr int kMovingTubeSides = 16;

/// The tree, leaning about its foot by its tip's displacement over its height.
Eigen::Affine3d Lean(const Eigen::Affine3d& at_rest, const Vector3& tip_window_m, double height_m) {
  Eigen::Affine3d leaning = at_rest;
  const double angle_rad = tip_window_m.norm() / height_m;
  if (!(angle_rad > 0.0)) return leaning;
  const Vector3 axis = Vector3::UnitZ().cross(tip_window_m).normalized();
  leaning.linear() = Eigen::AngleAxisd(angle_rad, axis) * at_rest.linear();
  return leaning;
}

TracePlacement PlaceTree(const SwayingThings::Tree& tree, const Wind& wind, const SwayView& view) {
  TracePlacement placement{tree.at_rest.model, {}, tree.at_rest.first_surface};
  // Rounded up, but a frame that is a rounding longer than a step has one.
  const int num_intervals =
      std::max(1, static_cast<int>(std::ceil(view.duration_s / kTreeStep_s - 1e-3)));
  for (int step = 0; step <= num_intervals; ++step) {
    const double time_s = view.stamp_s + view.duration_s * step / num_intervals;
    const Vector3 tip_m = view.window_from_world.linear() * TreeTip_m(wind, tree.in_wind, time_s);
    placement.window_from_model.push_back(
        Lean(tree.at_rest.window_from_model.front(), tip_m, tree.in_wind.height_m));
  }
  return placement;
}

/// A straight piece of a wire at the frame's beginning and at its end.
struct WirePiece {
  std::array<Vector3, 2> begin_m;
  std::array<Vector3, 2> end_m;
  double radius_m{};
};

/// The places of UnitTube() that make it the piece. Its section keeps its orientation.
std::vector<Eigen::Affine3d> PlacesOf(const WirePiece& piece) {
  const Vector3 along = (piece.end_m[0] - piece.begin_m[0]).normalized();
  const Vector3 side = Vector3::UnitZ().cross(along);
  const Vector3 across = side.norm() > 0.1 ? side.normalized() : along.unitOrthogonal();
  std::vector<Eigen::Affine3d> places;
  for (std::size_t k = 0; k < 2; ++k) {
    Eigen::Affine3d& place = places.emplace_back(Eigen::Affine3d::Identity());
    place.linear().col(0) = piece.end_m[k] - piece.begin_m[k];
    place.linear().col(1) = piece.radius_m * across;
    place.linear().col(2) = piece.radius_m * along.cross(across);
    place.translation() = piece.begin_m[k];
  }
  return places;
}

bool IsInReach(const SwayView& view, const Vector3& center_m, double radius_m) {
  return (center_m - view.sensor_window_m).norm() <= view.reach_m + radius_m;
}

void SwayTrees(const SwayingThings& things,
               const Wind& wind,
               const SwayView& view,
               SwayedThings& swayed) {
  for (const SwayingThings::Tree& tree : things.trees) {
    // No tree is wider than high.
    const Vector3 foot_m = tree.at_rest.window_from_model.front().translation();
    if (!IsInReach(view, foot_m, 1.5 * tree.in_wind.height_m)) continue;
    swayed.placements.push_back(PlaceTree(tree, wind, view));
  }
}

void SwayWires(const SwayingThings& things,
               const Wind& wind,
               const SwayView& view,
               SwayedThings& swayed) {
  std::vector<std::array<Vector3, 2>> middles_m;  // By span: at the beginning and at the end.
  for (const WireSpan& span : things.spans) {
    const Vector3 left = view.window_from_world.linear() * LeftOf(span);
    middles_m.push_back({SpanBlowOff_m(wind, span, view.stamp_s) * left,
                         SpanBlowOff_m(wind, span, view.stamp_s + view.duration_s) * left});
  }
  for (const SwayingThings::Wire& wire : things.wires) {
    const auto& [begin_m, end_m] = middles_m[wire.span];
    std::vector<Vector3> points_m = wire.points_m;
    std::vector<Vector3> moves_m;
    for (std::size_t i = 0; i < points_m.size(); ++i) {
      points_m[i] += wire.shares[i] * begin_m;
      moves_m.emplace_back(wire.shares[i] * (end_m - begin_m));
    }
    swayed.wires.Add(points_m, wire.radius_m, wire.surface, moves_m);
    for (std::size_t i = 0; i + 1 < points_m.size(); ++i) {
      const Vector3 half_m = 0.5 * (points_m[i + 1] - points_m[i]);
      if (!IsInReach(view, points_m[i] + half_m, half_m.norm())) continue;
      const WirePiece piece{{points_m[i], points_m[i] + moves_m[i]},
                            {points_m[i + 1], points_m[i + 1] + moves_m[i + 1]},
                            wire.radius_m};
      swayed.placements.push_back({things.tube, PlacesOf(piece), wire.surface});
    }
  }
}

}  // namespace

void SwayingThings::AddWire(const railcast::Wire& wire,
                            const Transform& world_from_chunk,
                            const Transform& window_from_world,
                            std::uint32_t surface) {
  const bool moves = wire.span.tension_n > 0.0;
  const auto [found, is_new] = span_of_number_.try_emplace({moves, wire.span.number}, spans.size());
  if (is_new) {
    spans.push_back(wire.span);
    spans.back().begin_m = world_from_chunk * wire.span.begin_m;
    spans.back().end_m = world_from_chunk * wire.span.end_m;
  }
  Wire& added = wires.emplace_back();
  for (const Vector3& point_m : wire.points_m) {
    added.shares.push_back(moves ? BlowOffShare(wire.span, point_m) : 0.0);
    added.points_m.emplace_back(window_from_world * (world_from_chunk * point_m));
  }
  added.radius_m = wire.radius_m;
  added.surface = surface;
  added.span = found->second;
}

Model UnitTube() {
  const double radius = 2.0 / (1.0 + std::cos(std::numbers::pi / kMovingTubeSides));
  const std::array<Vector3, 2> line_m{Vector3::Zero(), Vector3::UnitX()};
  return {"wire", {{MakeTube(line_m, radius, kMovingTubeSides), 0, 0, true}}};
}

SwayedThings Sway(const SwayingThings& things, const Wind& wind, const SwayView& view) {
  SwayedThings swayed;
  SwayTrees(things, wind, view, swayed);
  SwayWires(things, wind, view, swayed);
  return swayed;
}

}  // namespace railcast
