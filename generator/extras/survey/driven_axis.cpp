#include "generator/extras/survey/driven_axis.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "core/base/error.h"

namespace railcast {
namespace {

/// Knots of the spline: near enough for curves of 100 m, and far enough apart that errors of poses
/// do not bend it.
constexpr double kKnotSpacing_m = 8.0;

/// Places at top of rail, at least kKnotSpacing_m apart in plan. Where a recording has driven
/// what another one has, the places of the first are taken.
std::vector<Vector3> KnotsOf(const DrivenWay& way) {
  std::vector<Vector3> knots;
  for (const Transform& world_from_body : way.world_from_body) {
    const Vector3 place_m = world_from_body.translation() - way.above_rail_m * Vector3::UnitZ();
    const bool is_known = std::ranges::any_of(knots, [&](const Vector3& knot_m) {
      return (place_m - knot_m).head<2>().norm() < kKnotSpacing_m;
    });
    if (!is_known) knots.push_back(place_m);
  }
  return knots;
}

/// Whether the way never turns back.
bool GoesOn(const std::vector<Vector3>& knots) {
  for (std::size_t i = 2; i < knots.size(); ++i) {
    const Eigen::Vector2d before = (knots[i - 1] - knots[i - 2]).head<2>();
    const Eigen::Vector2d after = (knots[i] - knots[i - 1]).head<2>();
    if (before.dot(after) <= 0.0) return false;
  }
  return true;
}

/// Goes on by `beyond_m` in the direction from `inner_m` to `outer_m`, level.
void Extend(const Vector3& inner_m,
            const Vector3& outer_m,
            double beyond_m,
            std::vector<Vector3>& knots) {
  const Eigen::Vector2d ahead = (outer_m - inner_m).head<2>().normalized();
  const auto num_steps = static_cast<int>(std::ceil(beyond_m / kKnotSpacing_m));
  for (int i = 1; i <= num_steps; ++i) {
    Vector3 knot_m = outer_m;
    knot_m.head<2>() += beyond_m * i / num_steps * ahead;
    knots.push_back(knot_m);
  }
}

}  // namespace

std::optional<AlignmentSpec> AxisAlong(const DrivenWay& way, double beyond_m) {
  Check(!way.world_from_body.empty(), "a way has a place");
  std::vector<Vector3> driven = KnotsOf(way);
  if (!GoesOn(driven)) return std::nullopt;
  if (driven.size() == 1) {
    Vector3 ahead = way.world_from_body.front().linear().col(0);
    ahead.z() = 0.0;
    driven.push_back(driven.front() + kKnotSpacing_m * ahead.normalized());
  }
  std::vector<Vector3> knots;
  Extend(driven[1], driven[0], beyond_m, knots);
  knots = {knots.rbegin(), knots.rend()};
  knots.insert(knots.end(), driven.begin(), driven.end());
  Extend(driven[driven.size() - 2], driven.back(), beyond_m, knots);

  AlignmentSplineSpec spline;
  AlignmentSpec alignment;
  const Vector3 origin_m = knots.front().array().floor();
  alignment.origin_m = {origin_m.x(), origin_m.y(), knots.front().z()};
  for (const Vector3& knot_m : knots) {
    spline.points_m.push_back({knot_m.x() - origin_m.x(), knot_m.y() - origin_m.y()});
  }
  alignment.course = spline;
  // Chords are as long as the spline to 0.1 mm at a radius of 150 m.
  double s_m = 0.0;
  for (std::size_t i = 0; i + 1 < knots.size(); ++i) {
    const Vector3 step_m = knots[i + 1] - knots[i];
    const double chord_m = step_m.head<2>().norm();
    const double permil = 1e3 * step_m.z() / chord_m;
    const auto& known = alignment.gradients_permil;
    if (known.empty() ? permil != 0.0 : permil != known.back().value) {
      alignment.gradients_permil.push_back({s_m, permil});
    }
    s_m += chord_m;
  }
  if (!alignment.gradients_permil.empty() && alignment.gradients_permil.front().s_m > 0.0) {
    alignment.gradients_permil.insert(alignment.gradients_permil.begin(), {0.0, 0.0});
  }
  alignment.gradient_smoothing_m = kKnotSpacing_m;
  return alignment;
}

}  // namespace railcast
