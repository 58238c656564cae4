#pragma once

#include <limits>
#include <memory>
#include <span>
#include <utility>
#include <vector>

#include "core/rail/chunk/chunk_context.h"
#include "core/rail/line/rail_section.h"
#include "core/rail/track/track_models.h"
#include "railcast/scene.h"
#include "railcast/transform.h"

namespace railcast {

/// Parts that turnouts and diamond crossings share.

/// A place along a rail that is swept: where the track's frame lies, and how much of the rail is
/// left of what planing took from its back.
struct RailStation {
  Transform mesh_from_track = Transform::Identity();
  /// Width from the gauge face outwards, over the whole height; infinite = the whole rail.
  double width_m = std::numeric_limits<double>::infinity();
};

/// The running band of a rail and all the rest of its surface.
struct RailMeshes {
  Mesh band;
  Mesh rest;
};

/// The section of the left or right rail, of which nothing is farther than `width_m` behind the
/// gauge face. A blade that is planed to less than half its head is therefore lower, too. Points
/// keep their number and order, so that sections of different widths can be joined.
[[nodiscard]] RailSection PlanedSection(bool left, double width_m);

/// Sweeps the left or right rail along stations in rising chainage.
[[nodiscard]] RailMeshes SweepRail(bool left, std::span<const RailStation> stations);

/// Closes a rail at a station where it begins or ends.
void AppendRailEnd(const RailStation& station, bool left, bool faces_ahead, Mesh& mesh);

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
