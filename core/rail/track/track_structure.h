#pragma once

#include <cstddef>
#include <limits>
#include <memory>
#include <span>
#include <utility>
#include <vector>

#include "core/rail/base/rail_surfaces.h"
#include "core/rail/chunk/chunk_context.h"
#include "core/rail/line/rail_section.h"
#include "core/rail/network/junction_rails.h"
#include "railcast/scene.h"
#include "railcast/transform.h"
#include "railcast/world_spec.h"

namespace railcast {

/// A B70 sleeper in the track frame: 2600 x 300 mm; 214 mm high below the rail, 234 mm outside it
/// and 175 mm in the middle, where it is 220 mm wide; W14 fastenings on rail seats canted 1:40.
/// @param shift_m How much farther from the middle its rails lie, and its ends (RailShift_m).
[[nodiscard]] Model MakeConcreteSleeper(const RailSurfaces& surfaces, double shift_m);

/// A wooden sleeper in the track frame: 2600 x 260 x 160 mm, with baseplates canted 1:40.
[[nodiscard]] Model MakeWoodSleeper(const RailSurfaces& surfaces, double shift_m);

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

/// Models that are placed repeatedly in tracks.
struct TrackModels {
  /// Sleepers in the track frame; their rail seats fit the rails of RailSection. The sleepers have
  /// 92 (concrete) and 12 (wood) triangles, plus 168 for pads or plates and fastenings.
  std::shared_ptr<const Model> concrete_sleeper;
  std::shared_ptr<const Model> wood_sleeper;

  /// The bearers of turnouts (track/track_structure.h), from 1.6 m on, each 0.1 m longer.
  std::vector<std::shared_ptr<const Model>> concrete_bearers;
  std::vector<std::shared_ptr<const Model>> wood_bearers;
  std::shared_ptr<const Model> concrete_plate;
  std::shared_ptr<const Model> wood_plate;
  std::shared_ptr<const Model> point_machine;
};

[[nodiscard]] TrackModels MakeTrackModels(const AlignmentSpec& line, const RailSurfaces& surfaces);

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
