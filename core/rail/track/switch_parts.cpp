#include "core/rail/track/track_structure.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <utility>
#include <vector>

#include "core/rail/base/rail_surfaces.h"
#include "core/rail/chunk/sweep.h"
#include "core/rail/line/rail_section.h"
#include "core/rail/track/cross_section.h"

namespace railcast {
namespace {

using SectionPoints = std::vector<Eigen::Vector2d>;

/// Lower edge of the head: what lies above it and behind the plane is lowered to the height at
/// which the plane meets the top of the head.
constexpr double kHeadDepth_m = 0.045;

/// Highest z of the outline at distance `y_m` from the track's axis, for the left rail.
double TopAt_m(const SectionPoints& outline_m, double y_m) {
  double top_m = -std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i + 1 < outline_m.size(); ++i) {
    const Eigen::Vector2d& a = outline_m[i];
    const Eigen::Vector2d& b = outline_m[i + 1];
    if (std::min(a.x(), b.x()) > y_m || std::max(a.x(), b.x()) < y_m || a.x() == b.x()) continue;
    top_m = std::max(top_m, std::lerp(a.y(), b.y(), (y_m - a.x()) / (b.x() - a.x())));
  }
  return top_m;
}

/// Chords of 0.5 m deviate by 0.2 mm from the sharpest branch, of 190 m radius, and follow planed
/// blades and flares.
constexpr double kTurnoutStep_m = 0.5;

/// The check rail's profile beside its stock rail: its head reaches 20 mm above top of rail.
constexpr double kCheckTop_m = 0.020;
constexpr double kCheckBottom_m = -0.090;
constexpr double kCheckThickness_m = 0.060;
constexpr double kCheckFlare_m = 0.5;
constexpr double kCheckFlareOpening_m = 0.040;

/// How much farther than its flangeway a check rail stands from its stock rail, at its ends.
double CheckFlareAt_m(const CheckRail& rail, double s_m) {
  const double from_begin_m = rail.flares_at_begin ? s_m - rail.range.begin_s_m : kCheckFlare_m;
  const double from_end_m = rail.flares_at_end ? rail.range.end_s_m - s_m : kCheckFlare_m;
  const double from_tip_m = std::min(from_begin_m, from_end_m);
  return kCheckFlareOpening_m * std::clamp(1.0 - from_tip_m / kCheckFlare_m, 0.0, 1.0);
}

}  // namespace

RailSection PlanedSection(bool left, double width_m) {
  RailSection section = MakeRailSection(true);
  const double plane_m = 0.5 * kGauge_m + width_m;
  if (std::isfinite(plane_m)) {
    const double top_m = TopAt_m(section.outline_m, plane_m);
    for (Eigen::Vector2d& point : section.outline_m) {
      if (point.x() <= plane_m) continue;
      point.x() = plane_m;
      if (point.y() > -kHeadDepth_m) point.y() = std::min(point.y(), top_m);
    }
  }
  if (!left) {
    for (Eigen::Vector2d& point : section.outline_m) point.x() = -point.x();
    std::reverse(section.outline_m.begin(), section.outline_m.end());
  }
  return section;
}

RailMeshes SweepRail(bool left, std::span<const RailStation> stations) {
  RailMeshes meshes;
  RailSection section;
  for (std::size_t k = 0; k < stations.size(); ++k) {
    if (k == 0 || stations[k].width_m != stations[k - 1].width_m) {
      section = PlanedSection(left, stations[k].width_m);
    }
    const std::span<const Eigen::Vector2d> outline(section.outline_m);
    const std::size_t band_length = section.head_last - section.head_first + 1;
    // The rest of the outline runs from the band down, below the foot and up again.
    SectionPoints rest(outline.begin() + static_cast<std::ptrdiff_t>(section.head_last),
                       outline.end());
    rest.insert(rest.end(), outline.begin(),
                outline.begin() + static_cast<std::ptrdiff_t>(section.head_first) + 1);
    AppendRow(stations[k].mesh_from_track, outline.subspan(section.head_first, band_length),
              meshes.band);
    AppendRow(stations[k].mesh_from_track, rest, meshes.rest);
    if (k == 0) continue;
    JoinRows(band_length, meshes.band);
    JoinRows(rest.size(), meshes.rest);
  }
  return meshes;
}

void AppendRailEnd(const RailStation& station, bool left, bool faces_ahead, Mesh& mesh) {
  const RailSection section = PlanedSection(left, station.width_m);
  const auto base = static_cast<std::uint32_t>(mesh.vertices.size());
  const auto last = static_cast<std::uint32_t>(section.outline_m.size() - 1);
  AppendRow(station.mesh_from_track, section.outline_m, mesh);
  // Point i of the section mirrors point size - 1 - i, so strips between mirrored points fill it.
  const auto add = [&](std::uint32_t a, std::uint32_t b, std::uint32_t c) {
    if (faces_ahead) std::swap(b, c);
    mesh.triangles.push_back({base + a, base + b, base + c});
  };
  for (std::uint32_t i = 0; i + 1 < last - i; ++i) {
    add(i, i + 1, last - i);
    if (i + 1 < last - i - 1) add(i + 1, last - i - 1, last - i);
  }
}

Transform StationOf(const ChunkContext& context,
                    const PairOfTracks& tracks,
                    bool on_branch,
                    const std::pair<double, double>& place) {
  const TrackCourse& course = context.tracks[on_branch ? tracks.branch : tracks.track];
  const auto [s_m, d_m] = place;
  // Without cant the same, but for rounding.
  if (context.alignment.At(s_m).cant_rad == 0.0) {
    return context.chunk_from_world * course.WorldFromTrack(context.alignment, s_m, d_m);
  }
  return context.chunk_from_world * course.WorldFromTrack(context.alignment, s_m) *
         Eigen::Translation3d(0.0, d_m, 0.0);
}

bool HoldsChainage(const ChainageRange& range, double s_m) {
  return s_m >= range.begin_s_m && s_m <= range.end_s_m;
}

bool IsEmpty(const ChainageRange& range) {
  return range.end_s_m - range.begin_s_m < kChunkOverlap_m;
}

void AddRailPiece(const ChunkContext& context,
                  const PairOfTracks& tracks,
                  const TurnoutRail& rail,
                  Chunk& chunk) {
  const ChainageRange range = SweptRange(context, rail.range);
  if (IsEmpty(range)) return;
  std::vector<RailStation> stations;
  for (const double s_m : GridStations(range, kTurnoutStep_m)) {
    stations.push_back({StationOf(context, tracks, rail.follows_branch, {s_m, rail.aside_m(s_m)}),
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

void AddCheckRail(const ChunkContext& context,
                  const PairOfTracks& tracks,
                  const CheckRail& rail,
                  Chunk& chunk) {
  const ChainageRange range = SweptRange(context, rail.range);
  if (IsEmpty(range)) return;
  const double side = rail.is_left ? 1.0 : -1.0;
  const double face_m = side * (0.5 * kGauge_m - rail.flangeway_m);
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
        StationOf(context, tracks, rail.follows_branch, {s_m, -side * CheckFlareAt_m(rail, s_m)}));
  }
  AppendSweep(stations, outline_m, MeshOf(context.surfaces.turnouts.rail, chunk.ground));
}

MadeBearer BearerOf(const TrackModels& models,
                    SleeperType sleeper,
                    double length_m,
                    bool is_at_most) {
  const auto& bearers =
      sleeper == SleeperType::kConcrete ? models.concrete_bearers : models.wood_bearers;
  const double steps = (length_m - kShortestBearer_m) / kBearerStep_m;
  const double whole = is_at_most ? std::floor(steps + 1e-9) : std::ceil(steps - 1e-9);
  const auto index =
      static_cast<std::size_t>(std::clamp(whole, 0.0, static_cast<double>(bearers.size() - 1)));
  return {bearers[index], kShortestBearer_m + kBearerStep_m * static_cast<double>(index)};
}

const std::shared_ptr<const Model>& PlateOf(const TrackModels& models, SleeperType sleeper) {
  return sleeper == SleeperType::kConcrete ? models.concrete_plate : models.wood_plate;
}

void PlaceModel(const std::shared_ptr<const Model>& model,
                const Transform& chunk_from_model,
                Chunk& chunk) {
  chunk.placements.push_back(
      {.model = model, .chunk_from_model = Eigen::Affine3d(chunk_from_model), .instance = 0});
}

}  // namespace railcast
