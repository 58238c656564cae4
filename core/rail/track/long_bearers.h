#pragma once

#include <cstddef>
#include <vector>

#include "core/rail/chunk/chunk_context.h"
#include "core/rail/track/track_models.h"
#include "railcast/scene.h"

namespace railcast {

/// A long bearer at the place of a sleeper, seen from above in the plane of chainage and offset. It
/// lies in place of the sleepers of all its tracks.
struct LongBearer {
  std::vector<std::size_t> tracks;  ///< By index, from right to left.
  double s_m{};
  double d_m{};
  double heading_rad{};  ///< It is square to this, against the alignment.
  SleeperType sleeper{};
};

/// All long bearers at the chainage of a sleeper.
///
/// Turnouts and diamonds need one bearer under both of their tracks. Those that have a track in
/// common there or would lie in each other are one bearer; so is a sleeper of another track that
/// would lie in one.
///
/// A turnout's bearers are square to its through track, but turn square to the alignment over the
/// last eight of them, so that they meet both tracks at the sleepers' chainages where these have
/// sleepers of their own. A diamond's are square to the middle between both tracks. One that serves
/// several of these has the mean of their directions. All turn by so little against the alignment
/// that their ends lie at most 0.2 m ahead of or behind their middles.
[[nodiscard]] std::vector<LongBearer> LongBearersAt(const ChunkContext& context, double s_m);

/// All long bearers of the chunk, in rising chainage.
[[nodiscard]] std::vector<LongBearer> LongBearersIn(const ChunkContext& context);

/// Whether one of them takes the place of the track's sleeper at `s_m`.
[[nodiscard]] bool ReplacesSleeper(const std::vector<LongBearer>& bearers,
                                   std::size_t track,
                                   double s_m);

/// Adds a bearer with the plates of its rails. Where canted tracks lie in different planes, it is
/// cut half way between them, and each part lies in the plane of its own tracks.
void AddLongBearer(const ChunkContext& context,
                   const LongBearer& bearer,
                   const TrackModels& models,
                   Chunk& chunk);

}  // namespace railcast
