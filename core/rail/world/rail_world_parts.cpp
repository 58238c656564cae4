#include "core/rail/world/rail_world_parts.h"

#include <algorithm>
#include <iterator>
#include <string>
#include <utility>
#include <variant>

#include "core/base/out_of_memory.h"
#include "core/rail/catenary/catenary.h"
#include "core/rail/clearance/cleared.h"
#include "core/rail/ground/terrain.h"
#include "core/rail/network/network_draft.h"
#include "core/rail/structures/structures.h"

namespace railcast {
namespace {

std::string NameOf(int chunk) {
  return "chunk " + std::to_string(chunk);
}

}  // namespace

LineKey KeyOf(const WorldDraft& draft, std::uint64_t seed) {
  LineKey key{draft.world, *draft.surfaces, seed, {}};
  key.world.objects.clear();
  key.world.trains.clear();
  key.world.vegetation = {};
  for (const TurnoutSite& turnout : draft.network.turnouts)
    key.positions.push_back(turnout.position);
  return key;
}

std::shared_ptr<const RailWorld::Line> RailWorld::LayLine(WorldDraft& draft, const LineKey& key) {
  const Alignment& alignment = *draft.alignment;
  Network network = Completed(std::move(draft.network));
  std::vector<LaidTurnout> turnouts = LayTurnouts(network);
  std::vector<LaidDiamond> diamonds = LayDiamonds(network);
  const ChunkGrid grid(alignment, kChunkLength_m, key.world.terrain.half_width_m);
  TilesOfChunks surveyed;
  if (draft.survey) surveyed = draft.survey->AssignTiles(alignment, grid);
  return std::make_shared<const Line>(
      Line{key.world, key.seed, key.surfaces, alignment, std::move(network), std::move(turnouts),
           std::move(diamonds), grid, std::move(*draft.catenary_plan),
           MakeTrackModels(key.world.alignment, key.surfaces),
           std::make_shared<const Model>(MakeMast(key.world.catenary, key.surfaces)),
           Landform(key.world.terrain, std::move(*draft.strip_width), std::move(draft.elevation),
                    key.seed),
           std::move(draft.survey), std::move(surveyed)});
}

ChunkContext RailWorld::Line::ContextOf(int chunk,
                                        const Transform& chunk_from_world,
                                        const WorldSpec& spec) const {
  return {.spec = spec,
          .alignment = alignment,
          .tracks = network.courses,
          .turnouts = turnouts,
          .surfaces = surfaces,
          .seed = seed,
          .chunk = chunk,
          .begin_s_m = grid.BeginOf(chunk),
          .end_s_m = grid.EndOf(chunk),
          .chunk_from_world = chunk_from_world,
          .land = &land,
          .diamonds = diamonds,
          .survey = survey.get()};
}

template <class Builder>
void RailWorld::Line::InContext(int chunk, const WorldSpec& spec, const Builder& build) const {
  ChunkContext context = ContextOf(chunk, grid.WorldFromChunk(chunk).inverse(), spec);
  // Cross-sections beyond are few.
  constexpr double kBeyond_m = 10.0;
  const ClearedAreas unballasted(TracksOf(context), Clearing::kBallast,
                                 context.begin_s_m - kBeyond_m, context.end_s_m + kBeyond_m);
  context.unballasted = &unballasted;
  WithinMemory([&] { return "building " + NameOf(chunk) + " of the line"; },
               [&] { build(context); });
}

Chunk RailWorld::Line::Build(int chunk, std::size_t level) const {
  Chunk built;
  built.ground.name = NameOf(chunk);
  InContext(chunk, world, [&](ChunkContext& context) {
    context.level = level;
    if (survey) {
      survey->Add(surveyed.tiles.at(static_cast<std::size_t>(chunk)), context.chunk_from_world,
                  built);
    } else {
      AddTerrain(context, built);
      AddTracks(context, track_models, built);
      AddCatenary(context, catenary_plan, mast_model, built);
    }
    AddStructures(context, built);
  });
  return built;
}

std::vector<Placement> RailWorld::Line::PlantsOf(int chunk,
                                                 const WorldSpec& spec,
                                                 const PlantModels& plants) const {
  Chunk planted;
  InContext(chunk, spec,
            [&](const ChunkContext& context) { AddVegetation(context, plants, planted); });
  return std::move(planted.placements);
}

std::vector<MovingBoom> RailWorld::Line::Booms() const {
  std::vector<MovingBoom> booms;
  for (const StructureSpec& structure : world.structures) {
    const auto* crossing = std::get_if<LevelCrossingSpec>(&structure);
    if (crossing == nullptr || crossing->barrier_angles_deg.empty()) continue;
    InContext(grid.ChunkAt(crossing->s_m), world, [&](const ChunkContext& context) {
      std::ranges::move(MovingBoomsOf(context, *crossing), std::back_inserter(booms));
    });
  }
  return booms;
}

}  // namespace railcast
