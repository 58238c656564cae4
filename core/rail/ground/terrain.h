#pragma once

#include "core/rail/chunk/chunk_context.h"
#include "railcast/scene.h"

namespace railcast {

/// Adds the ground: a strip of TerrainSpec's width that follows the line at formation height.
///
/// Two random heights are added, both functions of track coordinates (s, d), so that neighbouring
/// chunks agree. Roughness has the spec's sigma and wavelength and fades out below the ballast.
/// Undulation has the spec's sigma in waves of 30 and 12 m; it is 0 within 4 m of a track and
/// complete from 30 m on. The grid spacing is 0.5 m along the line; across it, 0.5 m up to 10 m
/// from the outermost tracks and then increasing by 15 % per grid line up to 2 m. Ground covered by
/// ballast is left out.
///
/// Where the terrain has a shape (landform.h), undulation is added to it, and the ground is the
/// terrain between the slopes of cuttings and embankments (landform.h). Where the strip narrows
/// (StripWidth), the columns beyond 10 m from the outermost tracks are squeezed. In both cases,
/// the cells beyond 100 m from the axis are 4 m long and up to 8 m wide.
///
/// Behind retaining walls the ground is as high as their tops (ground_rise.h). The step is
/// inside the wall, in cells of its own; chunks near such walls have all columns in their coarser
/// forms.
///
/// In the coarser forms, inner rows are 1 m apart, or half the wavelength of the roughness if that
/// is from 2 to 4 m; below, they are those of the finest, and so are the columns up to 10 m from
/// the tracks. Cells are up to 2 m wide across. The coarsest form has rows 5 m apart and cells up
/// to 4 m wide.
void AddTerrain(const ChunkContext& context, Chunk& chunk);

/// Adds the ground to a chunk, its triangles with the surfaces of TerrainSpec::cover.
///
/// With fields, by the middle of a triangle: gravel on the formation, up to kFormationEdge_m from a
/// track; meadow up to kVerge_m, where slopes are; beyond, parcels of 70 m by 110 m of the plan, of
/// which 55 in 100 are meadows and the others fields of soil. What a parcel is depends on the place
/// and the seed alone.
void AddGround(const ChunkContext& context, const Mesh& ground, Chunk& chunk);

inline constexpr double kVerge_m = 15.0;

}  // namespace railcast
