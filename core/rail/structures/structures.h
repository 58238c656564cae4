#pragma once

#include "core/rail/chunk/chunk_context.h"
#include "core/rail/network/world_tracks.h"
#include "railcast/scene.h"

namespace railcast {

/// Adds those parts of the world's structures that lie in the chunk. Parts of the same surface
/// share one mesh of the chunk's ground.
void AddStructures(const ChunkContext& context, Chunk& chunk);

/// Checks that names are unique, that tracks exist, and that the structures lie on them and within
/// the ground. Faults are lines like `/world/structures/3/track: must be one of "main" (got "x")`.
void CheckStructures(const WorldSpec& world, const LineOfTracks& line, WorldFaults& faults);

}  // namespace railcast
