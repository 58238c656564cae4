#include "core/rail/turnout/turnout_structure.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <memory>
#include <span>
#include <string>
#include <utility>

#include "core/rail/model_parts.h"
#include "core/rail/track/cross_section.h"
#include "core/rail/track/planed_rail.h"
#include "core/rail/track/rail_section.h"
#include "core/rail/track/sweep.h"
#include "core/scene/shapes.h"

namespace railcast {
namespace {

/// Chords of 0.5 m deviate by 0.2 mm from the sharpest branch, of 190 m radius, and follow planed
/// blades and flares.
constexpr double kTurnoutStep_m = 0.5;

/// Reach of a turnout from its beginning along the line, with its bearers.
constexpr double kLongestReach_m = 80.0;

/// The check rail's profile beside its stock rail: its head reaches 20 mm above top of rail.
constexpr double kCheckTop_m = 0.020;
constexpr double kCheckBottom_m = -0.090;
constexpr double kCheckThickness_m = 0.060;
constexpr double kCheckFlare_m = 0.5;
constexpr double kCheckFlareOpening_m = 0.040;

constexpr double kMachineFromAxis_m = 1.75;

TurnoutCourses TurnoutCoursesOf(const ChunkContext& context, const TurnoutSite& site) {
  return {site, context.tracks[site.track], context.tracks[site.branch]};
}

bool IsNear(const ChunkContext& context, const TurnoutSite& site) {
  return site.s_m > context.begin_s_m - kLongestReach_m &&
         site.s_m < context.end_s_m + kLongestReach_m;
}

Transform StationOf(const ChunkContext& context,
                    const TurnoutSite& site,
                    bool on_branch,
                    const std::pair<double, double>& place) {
  const TrackCourse& course = context.tracks[on_branch ? site.branch : site.track];
  return context.chunk_from_world *
         course.WorldFromTrack(context.alignment, place.first, place.second);
}

ChainageRange InChunk(const ChunkContext& context, const ChainageRange& range) {
  return {.begin_s_m = std::max(range.begin_s_m, context.begin_s_m - 0.5 * kChunkOverlap_m),
          .end_s_m = std::min(range.end_s_m, context.end_s_m + 0.5 * kChunkOverlap_m)};
}

bool IsEmpty(const ChainageRange& range) {
  return range.end_s_m - range.begin_s_m < kChunkOverlap_m;
}

bool HoldsChainage(const ChainageRange& range, double s_m) {
  return s_m >= range.begin_s_m && s_m <= range.end_s_m;
}

void AddRailPiece(const ChunkContext& context,
                  const TurnoutSite& site,
                  const TurnoutRail& rail,
                  Chunk& chunk) {
  const ChainageRange range = InChunk(context, rail.range);
  if (IsEmpty(range)) return;
  std::vector<RailStation> stations;
  for (const double s_m : GridStations(range, kTurnoutStep_m)) {
    stations.push_back({StationOf(context, site, rail.follows_branch, {s_m, rail.aside_m(s_m)}),
                        rail.width_m(s_m)});
  }
  RailMeshes meshes = SweepRail(rail.is_left, stations);
  if (rail.begins_openly && range.begin_s_m == rail.range.begin_s_m) {
    AppendRailEnd(stations.front(), rail.is_left, false, meshes.rest);
  }
  if (rail.ends_openly && range.end_s_m == rail.range.end_s_m) {
    AppendRailEnd(stations.back(), rail.is_left, true, meshes.rest);
  }
  const bool is_plain = rail.role == RailRole::kClosure;
  const RailSurfaces& surfaces = context.surfaces;
  MeshOf(is_plain ? surfaces.rail_head : surfaces.turnouts.running_band, chunk.ground)
      .Append(meshes.band);
  MeshOf(is_plain ? surfaces.rail_side : surfaces.turnouts.rail, chunk.ground).Append(meshes.rest);
}

/// How much farther than its flangeway a check rail stands from its stock rail, at its ends.
double CheckFlareAt_m(const CheckRail& rail, double s_m) {
  const double from_end_m = std::min(s_m - rail.range.begin_s_m, rail.range.end_s_m - s_m);
  return kCheckFlareOpening_m * std::clamp(1.0 - from_end_m / kCheckFlare_m, 0.0, 1.0);
}

void AddCheckRail(const ChunkContext& context,
                  const TurnoutSite& site,
                  const CheckRail& rail,
                  Chunk& chunk) {
  const ChainageRange range = InChunk(context, rail.range);
  if (IsEmpty(range)) return;
  const double side = rail.is_left ? 1.0 : -1.0;
  const double face_m = side * (0.5 * kGauge_m - kCheckFlangeway_m);
  const double back_m = face_m - side * kCheckThickness_m;
  const double right_m = std::min(face_m, back_m);
  const double left_m = std::max(face_m, back_m);
  // Clockwise with y to the right and z up, as AppendSweep() wants it.
  const std::vector<Eigen::Vector2d> outline_m = {{right_m, kCheckBottom_m},
                                                  {right_m, kCheckTop_m},
                                                  {left_m, kCheckTop_m},
                                                  {left_m, kCheckBottom_m},
                                                  {right_m, kCheckBottom_m}};
  std::vector<Transform> stations;
  for (const double s_m : GridStations(range, kTurnoutStep_m)) {
    stations.push_back(
        StationOf(context, site, rail.follows_branch, {s_m, -side * CheckFlareAt_m(rail, s_m)}));
  }
  AppendSweep(stations, outline_m, MeshOf(context.surfaces.turnouts.rail, chunk.ground));
}

/// Length of a bearer as it is made, to be found among the models.
std::size_t BearerIndex(double length_m, std::size_t num_models) {
  const double steps = std::ceil((length_m - 2.0 * kSleeperHalfLength_m) / kBearerStep_m - 1e-9);
  return std::min(static_cast<std::size_t>(std::max(0.0, steps)), num_models - 1);
}

/// A turnout's bearers with the plates of its rails.
class Bearers {
 public:
  Bearers(const ChunkContext& context, const TurnoutSite& site, const InfrastructureModels& models)
      : context_(context), site_(site), models_(models) {}

  void AddAt(double s_m, Chunk& chunk) const {
    const TrackOffset through = context_.tracks[site_.track].OffsetAt(s_m);
    const TrackOffset branch = context_.tracks[site_.branch].OffsetAt(s_m);
    const double apart_m = (branch.d_m - through.d_m) * std::cos(std::atan(through.slope));
    const double length_m = std::abs(apart_m) + 2.0 * kSleeperHalfLength_m;
    const bool is_concrete = IsConcrete();
    const auto& bearers = is_concrete ? models_.concrete_bearers : models_.wood_bearers;
    const std::size_t index = BearerIndex(length_m, bearers.size());
    const double made_m = 2.0 * kSleeperHalfLength_m + kBearerStep_m * static_cast<double>(index);
    // What the bearer is longer than needed is on the branch's side.
    const double middle_m = SignOf(site_.side) * (0.5 * made_m - kSleeperHalfLength_m);
    Place(bearers[index], StationOf(context_, site_, false, {s_m, middle_m}), chunk);
    const auto& plate = is_concrete ? models_.concrete_plate : models_.wood_plate;
    for (const bool on_branch : {false, true}) {
      for (const double side : {-1.0, 1.0}) {
        const double foot_m = side * RailFootMiddle_m().x();
        Place(plate, StationOf(context_, site_, on_branch, {s_m, foot_m}), chunk);
      }
    }
  }

 private:
  [[nodiscard]] bool IsConcrete() const {
    return context_.spec.tracks[site_.track].sleeper == SleeperType::kConcrete;
  }
  static void Place(const std::shared_ptr<const Model>& model,
                    const Transform& chunk_from_model,
                    Chunk& chunk) {
    chunk.placements.push_back(
        {.model = model, .chunk_from_model = Eigen::Affine3d(chunk_from_model), .instance = 0});
  }

  const ChunkContext& context_;
  const TurnoutSite& site_;
  const InfrastructureModels& models_;
};

void AddBearers(const ChunkContext& context,
                const LaidTurnout& turnout,
                const InfrastructureModels& models,
                Chunk& chunk) {
  const ChainageRange& range = turnout.extent.bearers;
  const Bearers bearers(context, turnout.site, models);
  const auto first = static_cast<std::int64_t>(std::floor(context.begin_s_m / kSleeperSpacing_m));
  const auto last = static_cast<std::int64_t>(std::ceil(context.end_s_m / kSleeperSpacing_m));
  for (std::int64_t k = first; k <= last; ++k) {
    const double s_m = static_cast<double>(k) * kSleeperSpacing_m;
    if (s_m < context.begin_s_m || s_m >= context.end_s_m) continue;
    if (HoldsChainage(range, s_m)) bearers.AddAt(s_m, chunk);
  }
}

/// The stretcher bar between the blades' tips, and the machine beside the through track that moves
/// it.
void AddDrive(const ChunkContext& context,
              const TurnoutSite& site,
              const InfrastructureModels& models,
              Chunk& chunk) {
  // Between two bearers, behind the tips.
  const double bay_s_m = kSleeperSpacing_m * (std::floor(site.s_m / kSleeperSpacing_m) + 0.5 +
                                              (site.opens_ahead() ? 2.0 : -2.0));
  if (bay_s_m < context.begin_s_m || bay_s_m >= context.end_s_m) return;
  const Transform chunk_from_track = StationOf(context, site, false, {bay_s_m, 0.0});
  const double machine_m = -SignOf(site.side) * kMachineFromAxis_m;
  chunk.placements.push_back(
      {.model = models.point_machine,
       .chunk_from_model = Eigen::Affine3d(StationOf(context, site, false, {bay_s_m, machine_m})),
       .instance = 0});
  constexpr double kBarHalfWidth_m = 0.030;
  const double far_m = SignOf(site.side) * 0.5 * kGauge_m;
  const Mesh bar = MakeBox({Vector3(-kBarHalfWidth_m, std::min(far_m, machine_m), -0.170),
                            Vector3(kBarHalfWidth_m, std::max(far_m, machine_m), -0.140)});
  MeshOf(context.surfaces.turnouts.rail, chunk.ground).Append(bar, chunk_from_track);
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
  std::sort(cuts.begin(), cuts.end(), [](const ChainageRange& a, const ChainageRange& b) {
    return a.begin_s_m < b.begin_s_m;
  });
  const ChainageRange whole = SweptRange(context, context.tracks[track]);
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

bool HasBearersAt(const ChunkContext& context, std::size_t track, double s_m) {
  return std::any_of(context.turnouts.begin(), context.turnouts.end(),
                     [&](const LaidTurnout& turnout) {
                       return (turnout.site.track == track || turnout.site.branch == track) &&
                              HoldsChainage(turnout.extent.bearers, s_m);
                     });
}

void AddTurnouts(const ChunkContext& context, const InfrastructureModels& models, Chunk& chunk) {
  for (const LaidTurnout& turnout : context.turnouts) {
    const TurnoutSite& site = turnout.site;
    if (!IsNear(context, site)) continue;
    const TurnoutCourses courses = TurnoutCoursesOf(context, site);
    for (const TurnoutRail& rail : RailsOf(courses)) AddRailPiece(context, site, rail, chunk);
    for (const CheckRail& rail : CheckRailsOf(courses)) AddCheckRail(context, site, rail, chunk);
    AddBearers(context, turnout, models, chunk);
    AddDrive(context, site, models, chunk);
  }
}

}  // namespace railcast
