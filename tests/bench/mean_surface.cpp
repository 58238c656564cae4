#include "tests/bench/mean_surface.h"

#include <algorithm>
#include <cmath>

#include "core/rail/land/land.h"
#include "core/rail/track/cross_section.h"

namespace railcast {
namespace {

WorldSpec WithoutRoughness(WorldSpec spec) {
  spec.terrain.roughness_sigma_m = 0.0;
  return spec;
}

/// Chainage and lateral position of the place.
Eigen::Vector2d TrackPlace(const Alignment& alignment, const Vector3& place_m, double near_s_m) {
  constexpr int kNumSteps = 30;
  constexpr double kCloseEnough_m = 1e-4;
  double s_m = near_s_m;
  for (int i = 0; i < kNumSteps; ++i) {
    const AxisPoint axis = alignment.At(std::clamp(s_m, 0.0, alignment.length_m()));
    const Eigen::Vector2d forward(std::cos(axis.heading_rad), std::sin(axis.heading_rad));
    const Eigen::Vector2d from_axis_m = place_m.head<2>() - axis.position_m.head<2>();
    const double ahead_m = from_axis_m.dot(forward);
    const double d_m = forward.x() * from_axis_m.y() - forward.y() * from_axis_m.x();
    if (std::abs(ahead_m) < kCloseEnough_m) return {s_m, d_m};
    s_m += ahead_m;
  }
  return {s_m, 0.0};
}

}  // namespace

MeanSurface::MeanSurface(const ScenarioSpec& scenario)
    : spec_(WithoutRoughness(scenario.world)),
      seed_(scenario.world.seed),
      alignment_(scenario.world.alignment),
      network_(MakeNetwork(spec_, alignment_.length_m())),
      surfaces_(LabelTable(scenario.labels), MaterialLibrary(scenario.materials)) {}

std::optional<double> MeanSurface::HeightAbove_m(const Vector3& place_world_m,
                                                 std::uint32_t label,
                                                 double near_s_m) const {
  if (label != surfaces_.ballast.label && label != surfaces_.ground.label) return std::nullopt;
  const Eigen::Vector2d place_m = TrackPlace(alignment_, place_world_m, near_s_m);
  const ChunkContext context{.spec = spec_,
                             .alignment = alignment_,
                             .tracks = network_.courses,
                             .turnouts = {},
                             .surfaces = surfaces_,
                             .seed = seed_,
                             .chunk_from_world = Transform::Identity()};
  const CrossSection section(context, place_m.x());
  const Vector3 surface_m =
      label == surfaces_.ground.label
          ? GroundPoint(context, section, place_m.x(), place_m.y())
          : section.PointAt(place_m.y(), section.BallastHeight_m(place_m.y()));
  return place_world_m.z() - surface_m.z();
}

}  // namespace railcast
