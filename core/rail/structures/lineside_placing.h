#pragma once

#include "core/rail/chunk/chunk_context.h"
#include "core/rail/structures/structure_track.h"
#include "railcast/scene.h"
#include "railcast/transform.h"

namespace railcast {

/// Adds a model to the chunk's own surfaces.
void AppendModel(const Model& model, const Transform& chunk_from_model, Chunk& chunk);

/// A place beside a track, for what stands upright.
struct LinesidePlace {
  double s_m{};
  double d_m{};      ///< Left of the track's axis.
  double yaw_rad{};  ///< Counterclockwise from the direction of increasing chainage.
};

/// Upright at the height of top of rail of the track's axis.
[[nodiscard]] Transform AtTopOfRail(const StructureTrack& track, const LinesidePlace& place);
/// Upright on the ground, where the model's footprint is lowest.
[[nodiscard]] Transform OnGround(const ChunkContext& context,
                                 const StructureTrack& track,
                                 const LinesidePlace& place,
                                 const Model& model);

}  // namespace railcast
