#include "core/rail/track/track_structure.h"

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "core/rail/base/rail_surfaces.h"
#include "core/rail/chunk/sweep.h"
#include "core/rail/line/rail_section.h"
#include "core/rail/track/cross_section.h"
#include "core/scene/shapes.h"

namespace railcast {
namespace {

/// Reach of a turnout from its beginning along the line, with its bearers.
constexpr double kLongestReach_m = 80.0;

constexpr double kMachineFromAxis_m = 1.75;

TurnoutCourses TurnoutCoursesOf(const ChunkContext& context, const TurnoutSite& site) {
  return {site, context.tracks[site.track], context.tracks[site.branch]};
}

bool IsNear(const ChunkContext& context, const TurnoutSite& site) {
  return site.s_m > context.begin_s_m - kLongestReach_m &&
         site.s_m < context.end_s_m + kLongestReach_m;
}

bool IsNearDiamond(const ChunkContext& context, const DiamondSite& site) {
  return site.s_m > context.begin_s_m - kDiamondReach_m &&
         site.s_m < context.end_s_m + kDiamondReach_m;
}

PairOfTracks PairOf(const TurnoutSite& site) {
  return {site.track, site.branch};
}

/// The stretcher bar between the blades' tips, and the machine beside the through track that moves
/// it.
void AddDrive(const ChunkContext& context,
              const TurnoutSite& site,
              const TrackModels& models,
              Chunk& chunk) {
  // Between two bearers, behind the tips.
  const double bay_s_m = kSleeperSpacing_m * (std::floor(site.s_m / kSleeperSpacing_m) + 0.5 +
                                              (site.opens_ahead() ? 2.0 : -2.0));
  if (bay_s_m < context.begin_s_m || bay_s_m >= context.end_s_m) return;
  const Transform chunk_from_track = StationOf(context, PairOf(site), false, {bay_s_m, 0.0});
  const double machine_m = -SignOf(site.side) * kMachineFromAxis_m;
  PlaceModel(models.point_machine, StationOf(context, PairOf(site), false, {bay_s_m, machine_m}),
             chunk);
  constexpr double kBarHalfWidth_m = 0.030;
  const double far_m = SignOf(site.side) * 0.5 * kGauge_m;
  const Mesh bar = MakeBox({Vector3(-kBarHalfWidth_m, std::min(far_m, machine_m), -0.170),
                            Vector3(kBarHalfWidth_m, std::max(far_m, machine_m), -0.140)});
  MeshOf(context.surfaces.turnouts.rail, chunk.ground).Append(bar, chunk_from_track);
}

/// By level.
constexpr double kRailTolerances_m[1 + kMostCoarse] = {1e-3, 4e-3, 16e-3};
constexpr double kLongestRailChords_m[1 + kMostCoarse] = {2.5, 5.0, 10.0};

void AddRail(const ChunkContext& context,
             const TrackCourse& track,
             bool is_left,
             const ChainageRange& range,
             Chunk& chunk) {
  std::vector<RailStation> stations;
  const double tolerance_m = kRailTolerances_m[context.level];
  const double chord_m = kLongestRailChords_m[context.level];
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
    PlaceModel(model, context.chunk_from_world * track.WorldFromTrack(context.alignment, s_m),
               chunk);
  }
}

}  // namespace

std::vector<ChainageRange> PlainRailRanges(const ChunkContext& context,
                                           std::size_t track,
                                           bool is_left) {
  std::vector<ChainageRange> cuts;
  for (const auto& [site, extent] : context.turnouts) {
    const bool branch_is_left = site.side == TrackSide::kLeft;
    if (site.track == track && is_left == branch_is_left) cuts.push_back(extent.through_rail);
    if (site.branch == track && is_left != branch_is_left) cuts.push_back(extent.branch_rail);
  }
  for (const auto& [site, extent] : context.diamonds) {
    const std::size_t rail = is_left ? 1 : 0;
    if (site.first == track) cuts.push_back(extent.first_rails[rail]);
    if (site.second == track) cuts.push_back(extent.second_rails[rail]);
  }
  std::sort(cuts.begin(), cuts.end(), [](const ChainageRange& a, const ChainageRange& b) {
    return a.begin_s_m < b.begin_s_m;
  });
  const ChainageRange whole =
      SweptRange(context, {context.tracks[track].begin_s_m(), context.tracks[track].end_s_m()});
  std::vector<ChainageRange> ranges;
  double from_s_m = whole.begin_s_m;
  for (const ChainageRange& cut : cuts) {
    ranges.push_back({.begin_s_m = from_s_m, .end_s_m = std::min(whole.end_s_m, cut.begin_s_m)});
    from_s_m = std::max(from_s_m, cut.end_s_m);
  }
  ranges.push_back({.begin_s_m = from_s_m, .end_s_m = whole.end_s_m});
  // A shorter range is only the overlap with the chunk in which the rail begins or ends.
  std::erase_if(ranges, IsEmpty);
  return ranges;
}

void AddTurnouts(const ChunkContext& context, const TrackModels& models, Chunk& chunk) {
  for (const LaidTurnout& turnout : context.turnouts) {
    const TurnoutSite& site = turnout.site;
    if (!IsNear(context, site)) continue;
    const TurnoutCourses courses = TurnoutCoursesOf(context, site);
    for (const TurnoutRail& rail : RailsOf(courses)) {
      AddRailPiece(context, PairOf(site), rail, chunk);
    }
    for (const CheckRail& rail : CheckRailsOf(courses)) {
      AddCheckRail(context, PairOf(site), rail, chunk);
    }
    AddDrive(context, site, models, chunk);
  }
}

void AddDiamonds(const ChunkContext& context, Chunk& chunk) {
  for (const LaidDiamond& diamond : context.diamonds) {
    const DiamondSite& site = diamond.site;
    if (!IsNearDiamond(context, site)) continue;
    const DiamondCourses courses{site, context.tracks[site.first], context.tracks[site.second]};
    const PairOfTracks pair{site.first, site.second};
    for (const TurnoutRail& rail : RailsOf(courses)) AddRailPiece(context, pair, rail, chunk);
    for (const CheckRail& rail : CheckRailsOf(courses)) AddCheckRail(context, pair, rail, chunk);
  }
}

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
