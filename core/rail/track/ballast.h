#pragma once

#include "core/rail/chunk_context.h"
#include "core/scene/world.h"

namespace railcast {

/// Adds the ballast of all tracks: one sheet over the highest ballast of them (CrossSection), so
/// that tracks side by side share it, with the grain of 31.5/63 mm stones as a random height at
/// every point of a grid of 0.2 m along by 0.16 m across.
///
/// The grid is what a LiDAR can tell apart: beams 0.25 degrees apart are 0.16 m apart at 37 m, and
/// grain below it is the material's roughness. 36 k triangles per 100 m of single track. The sheet
/// ends where it is a good way below the ground.
void AddBallast(const ChunkContext& context, Chunk& chunk);

}  // namespace railcast
