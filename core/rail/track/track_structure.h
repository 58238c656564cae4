#pragma once

#include <cstddef>
#include <limits>
#include <memory>
#include <span>
#include <utility>
#include <vector>

#include "core/rail/chunk/chunk_context.h"
#include "core/rail/line/rail_section.h"
#include "core/rail/network/junction_rails.h"
#include "core/rail/track/track_models.h"
#include "railcast/scene.h"
#include "railcast/transform.h"

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

/// Adds the ballast of all tracks as one sheet over the highest ballast (CrossSection), so that
/// adjacent tracks share it. The grain of the 31.5/63 mm stones is a random height at every point
/// of a grid of 0.2 m along by 0.16 m across.
///
/// The grid matches what a LiDAR can resolve: beams 0.25 degrees apart are 0.16 m apart at 37 m,
/// and finer grain is part of the material's roughness. It takes 36 k triangles per 100 m of single
/// track. The sheet ends well below the ground.
///
/// In the first coarser form, cells are up to 0.48 m wide across, where that keeps the mean height
/// within 5 mm, and as long along as ever: what beams along the track see stays. In the second,
/// they are up to 0.96 m wide and 3 m long.
void AddBallast(const ChunkContext& context, Chunk& chunk);

/// Adds every track of the chunk: rails, sleepers and ballast, all with the line's cant.
///
/// - Rails: the 60E1 section (RailSection) swept along each track's own frame. Chords deviate from
///   the true line by at most 1 mm and are no longer than 2.5 m, so that a kink of 1:400 in a cant
///   ramp is also met within 1 mm; in the first coarser form 4 mm and 5 m, in the second 16 mm and
///   10 m. The running band is a separate surface. Rails are closed where the track ends.
/// - Sleepers: placements at every integer multiple of 0.6 m of chainage (of the axis, for all
///   tracks).
/// - Ballast: AddBallast.
void AddTracks(const ChunkContext& context, const TrackModels& models, Chunk& chunk);

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
