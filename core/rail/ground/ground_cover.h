#pragma once

#include "core/rail/chunk/chunk_context.h"
#include "railcast/scene.h"

namespace railcast {

/// Adds the ground to a chunk, its triangles with the surfaces of TerrainSpec::cover.
///
/// With fields, by the middle of a triangle: gravel on the formation, up to kFormationEdge_m from a
/// track; meadow up to kVerge_m, where slopes are; beyond, parcels of 70 m by 110 m of the plan, of
/// which 55 in 100 are meadows and the others fields of soil. What a parcel is depends on the place
/// and the seed alone.
void AddGround(const ChunkContext& context, const Mesh& ground, Chunk& chunk);

inline constexpr double kVerge_m = 15.0;

}  // namespace railcast
