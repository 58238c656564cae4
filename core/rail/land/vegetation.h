#pragma once

#include "core/rail/chunk_context.h"
#include "core/rail/land/plant_models.h"
#include "core/scene/world.h"

namespace railcast {

/// Adds the trees and the grass of a chunk, standing on the ground of core/rail/land/terrain.h.
///
/// Trees are a Poisson process of VegetationSpec's density per hectare in plan, on both sides from
/// its least distance beyond the outermost track's axis to the edge of the ground; half are
/// broad-leaved. Heights are uniform within the spec's limits: the model that is nearest in height
/// is scaled to it.
///
/// Grass is one patch every 2 m along the line, in as many rows side by side as fill the strip from
/// its least to its largest distance beyond the outermost track's axis; a strip narrower than a
/// patch has none. Patches lie on the slope of the ground.
///
/// Keyed by (seed, chunk, plant), so that nothing depends on other chunks.
void AddVegetation(const ChunkContext& context, const PlantModels& plants, Chunk& chunk);

}  // namespace railcast
