#pragma once

#include <vector>

#include "core/rail/chunk/chunk_context.h"
#include "core/rail/network/turnout_rails.h"
#include "core/rail/track/track_models.h"
#include "railcast/scene.h"

namespace railcast {

/// The parts of a track's left or right rail that lie in the chunk and are not replaced by pieces
/// of turnouts and diamond crossings, in rising chainage.
[[nodiscard]] std::vector<ChainageRange> PlainRailRanges(const ChunkContext& context,
                                                         std::size_t track,
                                                         bool is_left);

/// Adds the turnouts of the chunk: blades, closure rails, frog with wing rails and nose, check
/// rails, stretcher bars and the point machine. The blades lie as
/// TurnoutSite says, the open one 160 mm off at its tip.
void AddTurnouts(const ChunkContext& context, const TrackModels& models, Chunk& chunk);

/// Adds the diamond crossings of the chunk: acute frogs with wing rails, noses and check rails,
/// obtuse frogs with their knuckles and check rails, and the rails between them.
void AddDiamonds(const ChunkContext& context, Chunk& chunk);

}  // namespace railcast
