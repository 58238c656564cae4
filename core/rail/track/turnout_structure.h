#pragma once

#include <vector>

#include "core/rail/base/rail_surfaces.h"
#include "core/rail/chunk/chunk_context.h"
#include "core/rail/network/turnout_rails.h"
#include "core/rail/track/infrastructure_models.h"
#include "railcast/scene.h"

namespace railcast {

/// The parts of a track's left or right rail that lie in the chunk and are not replaced by pieces
/// of turnouts and diamond crossings, in rising chainage.
[[nodiscard]] std::vector<ChainageRange> PlainRailRanges(const ChunkContext& context,
                                                         std::size_t track,
                                                         bool is_left);

/// Lengths in which bearers are made: from a part in a crossover on cant up to that under all four
/// tracks of a scissors crossover.
inline constexpr double kBearerStep_m = 0.1;
inline constexpr double kShortestBearer_m = 1.6;
inline constexpr double kLongestBearer_m = 12.0;

/// Long bearers under the tracks of a turnout, in steps of 0.1 m as they are made, in the frame of
/// a track in whose plane they lie, with their middle at the origin. 300 (concrete) or
/// 260 mm (wood) wide; their tops are as high as those of sleepers. 12 triangles each.
[[nodiscard]] Model MakeBearer(SleeperType sleeper, double length_m, const RailSurfaces& surfaces);

/// A plate with two clips under one rail on a bearer: 36 triangles. In the frame of a track, below
/// its left rail's place moved to the axis.
[[nodiscard]] Model MakeRailPlate(SleeperType sleeper, const RailSurfaces& surfaces);

/// A point machine: 0.95 x 0.50 x 0.35 m, in the frame of a track, with its middle at the origin
/// and its top at the height of top of rail less 50 mm. 12 triangles.
[[nodiscard]] Model MakePointMachine(const RailSurfaces& surfaces);

/// Adds the turnouts of the chunk: blades, closure rails, frog with wing rails and nose, check
/// rails, stretcher bars and the point machine. The blades lie as
/// TurnoutSite says, the open one 160 mm off at its tip.
void AddTurnouts(const ChunkContext& context, const InfrastructureModels& models, Chunk& chunk);

/// Adds the diamond crossings of the chunk: acute frogs with wing rails, noses and check rails,
/// obtuse frogs with their knuckles and check rails, and the rails between them.
void AddDiamonds(const ChunkContext& context, Chunk& chunk);

}  // namespace railcast
