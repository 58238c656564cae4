#pragma once

#include <memory>
#include <utility>
#include <vector>

#include "core/rail/chunk/chunk_context.h"
#include "core/rail/track/track_models.h"
#include "railcast/scene.h"

namespace railcast {

/// Parts that turnouts and diamond crossings share.

/// The tracks that share a turnout or a crossing, by index.
struct PairOfTracks {
  std::size_t track{};
  std::size_t branch{};  ///< Or the second track of a diamond.
};

/// The frame of one of the tracks at a place (s, d), in that of the chunk; d is measured in the
/// canted plane of the track.
[[nodiscard]] Transform StationOf(const ChunkContext& context,
                                  const PairOfTracks& tracks,
                                  bool on_branch,
                                  const std::pair<double, double>& place);

[[nodiscard]] bool HoldsChainage(const ChainageRange& range, double s_m);
[[nodiscard]] bool IsEmpty(const ChainageRange& range);

/// Adds what lies in the chunk of a rail.
void AddRailPiece(const ChunkContext& context,
                  const PairOfTracks& tracks,
                  const TurnoutRail& rail,
                  Chunk& chunk);
void AddCheckRail(const ChunkContext& context,
                  const PairOfTracks& tracks,
                  const CheckRail& rail,
                  Chunk& chunk);

/// A bearer at least as long as needed, or at most as long; the longest or shortest if there is
/// none.
struct MadeBearer {
  std::shared_ptr<const Model> model;
  double length_m{};
};
[[nodiscard]] MadeBearer BearerOf(const TrackModels& models,
                                  SleeperType sleeper,
                                  double length_m,
                                  bool is_at_most);
[[nodiscard]] const std::shared_ptr<const Model>& PlateOf(const TrackModels& models,
                                                          SleeperType sleeper);

/// Places a model that moves with nothing.
void PlaceModel(const std::shared_ptr<const Model>& model,
                const Transform& chunk_from_model,
                Chunk& chunk);

}  // namespace railcast
