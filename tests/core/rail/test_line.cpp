#include "tests/core/rail/test_line.h"

#include <utility>

#include "core/rail/catenary/catenary.h"
#include "core/rail/ground/terrain.h"
#include "core/rail/network/network_draft.h"
#include "core/rail/structures/structures.h"
#include "core/rail/track/track_structure.h"
#include "tests/core/rail/test_tables.h"
#include "tests/support/world_specs.h"

namespace railcast {
namespace {

std::optional<DemHeights> ElevationOf(const TerrainSpec& spec) {
  return spec.elevation ? std::optional(DemHeights(*spec.elevation)) : std::nullopt;
}

}  // namespace

TestLine::TestLine(WorldSpec spec, std::uint64_t seed)
    : spec_(std::move(spec)),
      alignment_(spec_.alignment),
      network_(MakeNetwork(spec_, alignment_.length_m())),
      turnouts_(LayTurnouts(network_)),
      diamonds_(LayDiamonds(network_)),
      surfaces_(TestSurfaces()),
      seed_(seed),
      plan_({spec_, network_.courses}, alignment_),
      models_(MakeTrackModels(spec_.alignment, surfaces_)),
      mast_model_(std::make_shared<const Model>(MakeMast(spec_.catenary, surfaces_))),
      land_(spec_.terrain,
            StripWidth(alignment_, spec_.terrain.half_width_m),
            ElevationOf(spec_.terrain),
            seed) {}

Transform TestLine::WorldFromChunk(int chunk) const {
  const AxisPoint middle = alignment_.At((chunk + 0.5) * kChunkLength_m);
  return MakeTransform(RotationFromYawPitchRoll(middle.heading_rad, 0.0, 0.0), middle.position_m);
}

ChunkContext TestLine::Context(int chunk) const {
  return {.spec = spec_,
          .alignment = alignment_,
          .tracks = network_.courses,
          .turnouts = turnouts_,
          .surfaces = surfaces_,
          .seed = seed_,
          .chunk = chunk,
          .begin_s_m = chunk * kChunkLength_m,
          .end_s_m = (chunk + 1) * kChunkLength_m,
          .chunk_from_world = WorldFromChunk(chunk).inverse(),
          .land = &land_,
          .diamonds = diamonds_};
}

Chunk TestLine::Build(int chunk, std::size_t level) const {
  Chunk built;
  ChunkContext context = Context(chunk);
  context.level = level;
  AddTracks(context, models_, built);
  AddCatenary(context, plan_, mast_model_, built);
  AddTerrain(context, built);
  AddStructures(context, built);
  return built;
}

WorldSpec StraightLine(double length_m) {
  return WorldAlong({{ElementType::kStraight, length_m, std::nullopt}});
}

WorldSpec CantedArc(double length_m, double radius_m) {
  WorldSpec spec = WorldAlong({{ElementType::kArc, length_m, radius_m}});
  // Far above the equilibrium speed, so that cant has its maximum.
  spec.alignment.speed_limits_kmph = {{0.0, 200.0}};
  return spec;
}

bool IsCleared(const WorldSpec& spec, double s_m, double d_m, Clearing what) {
  const Network network = MakeNetwork(spec, Alignment(spec.alignment).length_m());
  return IsCleared(WorldTracks{spec, network.courses}, s_m, d_m, what);
}

Mesh MeshOfSurface(const Chunk& chunk, const SurfaceClass& surface) {
  for (const Part& part : chunk.ground.parts) {
    if (part.material == surface.material && part.label == surface.label) return part.mesh;
  }
  return {};
}

}  // namespace railcast
