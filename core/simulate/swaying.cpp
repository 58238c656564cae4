#include "core/simulate/swaying.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "core/base/units.h"
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

Eigen::Affine3d TreeAt(const SwayingThings::Tree& tree,
                       const Wind& wind,
                       const SwayView& view,
                       double time_s) {
  const Vector3 tip_m = view.window_from_world.linear() * TreeTip_m(wind, tree.in_wind, time_s);
  return Lean(tree.at_rest.window_from_model.front(), tip_m, tree.in_wind.height_m);
}

// Rounded up, but a frame that is a rounding longer than a step has one.
int NumTreeIntervals(const SwayView& view) {
  return std::max(1, static_cast<int>(std::ceil(view.duration_s / kTreeStep_s - 1e-3)));
}

TracePlacement PlaceTree(const SwayingThings::Tree& tree, const Wind& wind, const SwayView& view) {
  TracePlacement placement{tree.at_rest.model, {}, tree.at_rest.first_surface};
  const int num_intervals = NumTreeIntervals(view);
  for (int step = 0; step <= num_intervals; ++step) {
    const double time_s = view.stamp_s + view.duration_s * step / num_intervals;
    placement.window_from_model.push_back(TreeAt(tree, wind, view, time_s));
  }
  return placement;
}

/// Velocities of a thing that is at `place_at(time_s)`.
template <typename PlaceAt>
VelocityFields VelocitiesOf(const SwayView& view, int num_intervals, const PlaceAt& place_at) {
  const auto places_at = [&](std::int64_t since_stamp_ns) {
    return std::vector<Eigen::Affine3d>{place_at(view.stamp_s + SecondsFromNs(since_stamp_ns))};
  };
  return VelocityFieldsOf(places_at, std::llround(view.duration_s * kNsPerS), num_intervals)
      .front();
}

/// Gives what moves as one surfaces of its own, copies of those of the window from
/// `motion.first_surface` on.
/// @return The first of them.
std::uint32_t AddOwnSurfaces(const SwayView& view,
                             SurfaceMotions::Motion motion,
                             SwayedThings& swayed) {
  const std::uint32_t copied = motion.first_surface;
  motion.first_surface =
      *view.first_own_surface + static_cast<std::uint32_t>(swayed.own_surfaces.size());
  for (std::uint32_t i = 0; i < motion.num_surfaces; ++i) {
    swayed.own_surfaces.push_back(copied + i);
  }
  const std::uint32_t first = motion.first_surface;
  swayed.motions.Add(std::move(motion));
  return first;
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
    if (!view.first_own_surface) continue;
    const auto place_at = [&](double time_s) { return TreeAt(tree, wind, view, time_s); };
    swayed.placements.back().first_surface =
        AddOwnSurfaces(view,
                       {.first_surface = tree.at_rest.first_surface,
                        .num_surfaces = tree.num_surfaces,
                        .fields = VelocitiesOf(view, NumTreeIntervals(view), place_at)},
                       swayed);
  }
}

/// The surfaces of wires where velocities are measured, by span.
class OwnWireSurfaces {
 public:
  OwnWireSurfaces(const SwayingThings& things, const Wind& wind, const SwayView& view)
      : things_(things), wind_(wind), view_(view) {}

  /// The surface of a wire.
  [[nodiscard]] std::uint32_t Of(const SwayingThings::Wire& wire, SwayedThings& swayed) {
    if (!view_.first_own_surface) return wire.surface;
    const auto [found, is_new] = own_.try_emplace({wire.span, wire.surface}, 0);
    if (is_new) found->second = AddOwnSurfaces(view_, MotionOf(wire), swayed);
    return found->second;
  }

 private:
  // Spans follow the gusts within a frame, as trees do.
  [[nodiscard]] SurfaceMotions::Motion MotionOf(const SwayingThings::Wire& wire) const {
    const WireSpan& span = things_.spans[wire.span];
    const Vector3 left = view_.window_from_world.linear() * LeftOf(span);
    WireSpan in_window = span;
    in_window.begin_m = view_.window_from_world * span.begin_m;
    in_window.end_m = view_.window_from_world * span.end_m;
    const auto place_at = [&](double time_s) {
      return Eigen::Affine3d(Eigen::Translation3d(SpanBlowOff_m(wind_, span, time_s) * left));
    };
    return {.first_surface = wire.surface,
            .num_surfaces = 1,
            .fields = VelocitiesOf(view_, NumTreeIntervals(view_), place_at),
            .span = in_window};
  }

  const SwayingThings& things_;
  const Wind& wind_;
  const SwayView& view_;
  std::map<std::pair<std::size_t, std::uint32_t>, std::uint32_t> own_;  // By span and surface.
};

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
  OwnWireSurfaces surfaces(things, wind, view);
  for (const SwayingThings::Wire& wire : things.wires) {
    const std::uint32_t surface = surfaces.Of(wire, swayed);
    const auto& [begin_m, end_m] = middles_m[wire.span];
    std::vector<Vector3> points_m = wire.points_m;
    std::vector<Vector3> moves_m;
    for (std::size_t i = 0; i < points_m.size(); ++i) {
      points_m[i] += wire.shares[i] * begin_m;
      moves_m.emplace_back(wire.shares[i] * (end_m - begin_m));
    }
    swayed.wires.Add(points_m, wire.radius_m, surface, moves_m);
    for (std::size_t i = 0; i + 1 < points_m.size(); ++i) {
      const Vector3 half_m = 0.5 * (points_m[i + 1] - points_m[i]);
      if (!IsInReach(view, points_m[i] + half_m, half_m.norm())) continue;
      const WirePiece piece{{points_m[i], points_m[i] + moves_m[i]},
                            {points_m[i + 1], points_m[i + 1] + moves_m[i + 1]},
                            wire.radius_m};
      swayed.placements.push_back({things.tube, PlacesOf(piece), surface});
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
