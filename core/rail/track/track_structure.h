#pragma once

#include "core/rail/chunk_context.h"
#include "core/rail/infrastructure_models.h"
#include "core/scene/world.h"

namespace railcast {

/// Adds every track of the chunk: rails, sleepers and ballast, all with the line's cant.
///
/// - Rails: the 60E1 section (RailSection) swept along each track's own frame with chords off the
///   true line by at most 1 mm and no longer than 2.5 m (so that a kink of 1:400 in a cant ramp is
///   met within 1 mm too); the running band is a surface of its own. Closed where the track ends.
/// - Sleepers: placements at every whole multiple of 0.6 m of chainage (of the axis, for all
/// tracks).
/// - Ballast: AddBallast.
void AddTracks(const ChunkContext& context, const InfrastructureModels& models, Chunk& chunk);

}  // namespace railcast
