#pragma once

#include <vector>

#include "core/rail/chunk_context.h"
#include "core/rail/infrastructure_models.h"
#include "core/rail/rail_surfaces.h"
#include "core/rail/turnout/turnout_rails.h"
#include "railcast/scene.h"

namespace railcast {

/// The parts of a track's left or right rail that lie in the chunk and are not replaced by pieces
/// of turnouts and diamond crossings, in rising chainage.
[[nodiscard]] std::vector<ChainageRange> PlainRailRanges(const ChunkContext& context,
                                                         std::size_t track,
                                                         bool is_left);

/// Whether the sleepers of the track are replaced by long bearers at that chainage.
[[nodiscard]] bool HasBearersAt(const ChunkContext& context, std::size_t track, double s_m);

/// Lengths in which bearers are made, up to that under two tracks side by side.
inline constexpr double kBearerStep_m = 0.1;
inline constexpr double kLongestBearer_m = 5.4;

/// Long bearers under both tracks of a turnout, from 2.6 m on in steps of 0.1 m as they are made,
/// in the frame of the through track, of which the middle lies at the origin. 300 (concrete) or
/// 260 mm (wood) wide; their tops are as high as those of sleepers. 12 triangles each.
[[nodiscard]] Model MakeBearer(SleeperType sleeper, double length_m, const RailSurfaces& surfaces);

/// A plate with two clips under one rail on a bearer: 36 triangles. In the frame of a track, below
/// its left rail's place moved to the axis.
[[nodiscard]] Model MakeRailPlate(SleeperType sleeper, const RailSurfaces& surfaces);

/// A point machine: 0.95 x 0.50 x 0.35 m, in the frame of a track, with its middle at the origin
/// and its top at the height of top of rail less 50 mm. 12 triangles.
[[nodiscard]] Model MakePointMachine(const RailSurfaces& surfaces);

/// Adds the turnouts of the chunk: blades, closure rails, frog with wing rails and nose, check
/// rails, long bearers with plates, stretcher bars and the point machine. The blades lie as
/// TurnoutSite says, the open one 160 mm off at its tip.
void AddTurnouts(const ChunkContext& context, const InfrastructureModels& models, Chunk& chunk);

/// Adds the diamond crossings of the chunk: acute frogs with wing rails, noses and check rails,
/// obtuse frogs with their knuckles and check rails, the rails between them, and long bearers with
/// plates, square to the middle between both tracks.
void AddDiamonds(const ChunkContext& context, const InfrastructureModels& models, Chunk& chunk);

}  // namespace railcast
