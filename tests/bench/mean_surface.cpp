#include "tests/bench/mean_surface.h"

#include "core/rail/landform/ground_rise.h"
#include "core/rail/line/line_place.h"
#include "core/rail/network/network_draft.h"
#include "core/rail/track/cross_section.h"

namespace railcast {
namespace {

WorldSpec WithoutRoughness(WorldSpec spec) {
  spec.terrain.roughness_sigma_m = 0.0;
  return spec;
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
  const PlaceBesideLine place = PlaceOnLine(alignment_, place_world_m, near_s_m);
  const ChunkContext context{.spec = spec_,
                             .alignment = alignment_,
                             .tracks = network_.courses,
                             .turnouts = {},
                             .surfaces = surfaces_,
                             .seed = seed_,
                             .chunk_from_world = Transform::Identity()};
  const CrossSection section(context, place.s_m);
  const Vector3 surface_m = label == surfaces_.ground.label
                                ? GroundPoint(context, section, place.s_m, place.d_m)
                                : section.PointAt(place.d_m, section.BallastHeight_m(place.d_m));
  return place_world_m.z() - surface_m.z();
}

}  // namespace railcast
