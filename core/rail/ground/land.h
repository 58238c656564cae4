#pragma once

#include "core/rail/chunk/chunk_context.h"
#include "core/rail/ground/plant_models.h"
#include "core/rail/track/cross_section.h"
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
/// terrain between the slopes of cuttings and embankments (cut_and_fill.h). Where the strip narrows
/// (strip_width.h), the columns beyond 10 m from the outermost tracks are squeezed. In both cases,
/// the cells beyond 100 m from the axis are 4 m long and up to 8 m wide.
///
/// Behind retaining walls the ground is as high as their tops (retained_ground.h). The step is
/// inside the wall, in cells of its own; chunks near such walls have all columns in their coarser
/// form.
///
/// In the coarser form, inner rows are 1 m apart, or half the wavelength of the roughness if that
/// is from 2 to 4 m; below, they are those of the finest, and so are the columns up to 10 m from
/// the tracks. Cells are up to 2 m wide across.
void AddTerrain(const ChunkContext& context, Chunk& chunk);

/// The point of the ground at (s, d) in the chunk's frame: on the surface that AddTerrain samples
/// at its grid points.
[[nodiscard]] Vector3 GroundPoint(const ChunkContext& context, double s_m, double d_m);
/// As above, with the cross-section at `s_m`.
[[nodiscard]] Vector3 GroundPoint(const ChunkContext& context,
                                  const CrossSection& section,
                                  double s_m,
                                  double d_m);

/// Adds the trees and the grass of a chunk, standing on the ground of AddTerrain.
///
/// Trees form a Poisson process with VegetationSpec's density per hectare in plan, on both sides,
/// from its minimum distance beyond the axis of the outermost track to the edge of the ground; half
/// are broad-leaved. Heights are uniform within the spec's limits; the model closest in height is
/// scaled to the exact height.
///
/// Grass consists of one patch every 2 m along the line, in as many parallel rows as fill the strip
/// between its minimum and maximum distance beyond the axis of the outermost track. A strip
/// narrower than a patch has none. Patches lie on the slope of the ground.
///
/// With VegetationSpec::woods_share below 1, trees stand in woods (woods.h) only. Bushes form a
/// Poisson process, too; low ones are the most frequent. With grass_fade_m, patches of grass follow
/// beyond the strip at random places, ever fewer outwards. Nothing stands where the strip of ground
/// has narrowed.
///
/// Random numbers are keyed by (seed, chunk, plant), so chunks do not depend on each other.
void AddVegetation(const ChunkContext& context, const PlantModels& plants, Chunk& chunk);

}  // namespace railcast
