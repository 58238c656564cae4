#pragma once

#include "core/rail/chunk/chunk_context.h"
#include "core/rail/ground/plant_models.h"
#include "railcast/scene.h"

namespace railcast {

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
/// With VegetationSpec::woods_share below 1, trees stand in woods only. Bushes form a
/// Poisson process, too; low ones are the most frequent. With grass_fade_m, patches of grass follow
/// beyond the strip at random places, ever fewer outwards. Nothing stands where the strip of ground
/// has narrowed.
///
/// Random numbers are keyed by (seed, chunk, plant), so chunks do not depend on each other.
void AddVegetation(const ChunkContext& context, const PlantModels& plants, Chunk& chunk);

}  // namespace railcast
