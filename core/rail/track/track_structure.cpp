#include "core/rail/track/track_structure.h"

#include <cmath>
#include <vector>

#include "core/rail/base/model_parts.h"
#include "core/rail/chunk/sweep.h"
#include "core/rail/track/cross_section.h"
#include "core/rail/track/long_bearers.h"
#include "core/rail/track/planed_rail.h"
#include "core/rail/track/turnout_structure.h"

namespace railcast {
namespace {

constexpr double kRailTolerance_m = 1e-3;
constexpr double kLongestRailChord_m = 2.5;
constexpr double kCoarseRailTolerance_m = 4e-3;
constexpr double kLongestCoarseRailChord_m = 5.0;

void AddRail(const ChunkContext& context,
             const TrackCourse& track,
             bool is_left,
             const ChainageRange& range,
             Chunk& chunk) {
  std::vector<RailStation> stations;
  const double tolerance_m = context.is_coarse ? kCoarseRailTolerance_m : kRailTolerance_m;
  const double chord_m = context.is_coarse ? kLongestCoarseRailChord_m : kLongestRailChord_m;
  const double shift_m = RailShift_m(context.spec.alignment);
  for (const double s_m : SweepStations(context.alignment, range, track, tolerance_m, chord_m)) {
    stations.push_back({context.chunk_from_world * track.WorldFromTrack(context.alignment, s_m) *
                        Eigen::Translation3d(0.0, is_left ? shift_m : -shift_m, 0.0)});
  }
  RailMeshes meshes = SweepRail(is_left, stations);
  if (range.begin_s_m == track.begin_s_m()) {
    AppendRailEnd(stations.front(), is_left, false, meshes.rest);
  }
  if (range.end_s_m == track.end_s_m()) {
    AppendRailEnd(stations.back(), is_left, true, meshes.rest);
  }
  MeshOf(context.surfaces.rail_head, chunk.ground).Append(meshes.band);
  MeshOf(context.surfaces.rail_side, chunk.ground).Append(meshes.rest);
}

void AddSleepers(const ChunkContext& context,
                 std::size_t index,
                 const std::vector<LongBearer>& bearers,
                 const TrackModels& models,
                 Chunk& chunk) {
  const std::shared_ptr<const Model>& model =
      context.spec.tracks[index].sleeper == SleeperType::kConcrete ? models.concrete_sleeper
                                                                   : models.wood_sleeper;
  const TrackCourse& track = context.tracks[index];
  for (const double s_m : SleeperPlaces(context)) {
    if (s_m < track.begin_s_m() || s_m > track.end_s_m()) continue;
    if (ReplacesSleeper(bearers, index, s_m)) continue;
    const Transform chunk_from_track =
        context.chunk_from_world * track.WorldFromTrack(context.alignment, s_m);
    chunk.placements.push_back(
        {.model = model, .chunk_from_model = Eigen::Affine3d(chunk_from_track), .instance = 0});
  }
}

}  // namespace

void AddTracks(const ChunkContext& context, const TrackModels& models, Chunk& chunk) {
  const std::vector<LongBearer> bearers = LongBearersIn(context);
  for (std::size_t index = 0; index < context.tracks.size(); ++index) {
    AddSleepers(context, index, bearers, models, chunk);
    for (const bool is_left : {true, false}) {
      for (const ChainageRange& range : PlainRailRanges(context, index, is_left)) {
        AddRail(context, context.tracks[index], is_left, range, chunk);
      }
    }
  }
  AddTurnouts(context, models, chunk);
  AddDiamonds(context, chunk);
  for (const LongBearer& bearer : bearers) AddLongBearer(context, bearer, models, chunk);
  AddBallast(context, chunk);
}

}  // namespace railcast
