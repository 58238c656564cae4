#pragma once

#include "core/rail/chunk_context.h"
#include "core/scene/world.h"

namespace railcast {

/// Adds the ground: a strip that follows the line at formation height, in TerrainSpec's width.
///
/// Two random heights on track coordinates (s, d), so that neighbouring chunks agree: roughness of
/// the spec's sigma and wavelength, fading out below the ballast; and undulation of the spec's
/// sigma in waves of 30 and 12 m, nothing within 4 m of a track and full from 30 m on. The grid is
/// 0.5 m along the line; across it 0.5 m up to 10 m from the outermost tracks, then widening by 15
/// % from line to line up to 2 m. What ballast covers is left out.
void AddTerrain(const ChunkContext& context, Chunk& chunk);

/// Where the ground is at (s, d), in the chunk's frame: the surface that AddTerrain draws on its
/// grid.
[[nodiscard]] Vector3 GroundPoint(const ChunkContext& context, double s_m, double d_m);

}  // namespace railcast
