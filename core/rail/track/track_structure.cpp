#include "core/rail/track/track_structure.h"

#include <cmath>
#include <span>
#include <vector>

#include "core/rail/model_parts.h"
#include "core/rail/track/cross_section.h"
#include "core/rail/track/rail_section.h"
#include "core/rail/track/sweep.h"

namespace railcast {
namespace {

constexpr double kRailTolerance_m = 1e-3;
constexpr double kLongestRailChord_m = 2.5;
constexpr double kCoarseRailTolerance_m = 4e-3;
constexpr double kLongestCoarseRailChord_m = 5.0;

/// Closes a rail where it begins or ends. Point i of the section mirrors point size - 1 - i, so
/// strips between mirrored points fill it.
void AppendRailEnd(const Transform& chunk_from_track,
                   const RailSection& section,
                   bool faces_ahead,
                   Mesh& mesh) {
  const auto base = static_cast<std::uint32_t>(mesh.vertices.size());
  const auto last = static_cast<std::uint32_t>(section.outline_m.size() - 1);
  for (const Eigen::Vector2d& point : section.outline_m) {
    mesh.vertices.emplace_back(
        (chunk_from_track * Vector3(0.0, point.x(), point.y())).cast<float>());
  }
  const auto add = [&](std::uint32_t a, std::uint32_t b, std::uint32_t c) {
    if (faces_ahead) std::swap(b, c);
    mesh.triangles.push_back({base + a, base + b, base + c});
  };
  for (std::uint32_t i = 0; i + 1 < last - i; ++i) {
    add(i, i + 1, last - i);
    if (i + 1 < last - i - 1) add(i + 1, last - i - 1, last - i);
  }
}

void AddRail(const ChunkContext& context,
             const TrackCourse& track,
             const RailSection& section,
             const ChainageRange& range,
             Chunk& chunk) {
  std::vector<Transform> stations;
  const double tolerance_m = context.is_coarse ? kCoarseRailTolerance_m : kRailTolerance_m;
  const double chord_m = context.is_coarse ? kLongestCoarseRailChord_m : kLongestRailChord_m;
  for (const double s_m : SweepStations(context.alignment, range, track, tolerance_m, chord_m)) {
    stations.push_back(context.chunk_from_world * track.WorldFromTrack(context.alignment, s_m));
  }
  const std::span<const Eigen::Vector2d> outline(section.outline_m);
  const std::size_t band_length = section.head_last - section.head_first + 1;
  AppendSweep(stations, outline.subspan(section.head_first, band_length),
              MeshOf(context.surfaces.rail_head, chunk.ground));

  // The rest of the outline runs from the band down, below the foot and up again.
  std::vector<Eigen::Vector2d> rest(
      outline.begin() + static_cast<std::ptrdiff_t>(section.head_last), outline.end());
  rest.insert(rest.end(), outline.begin(),
              outline.begin() + static_cast<std::ptrdiff_t>(section.head_first) + 1);
  Mesh& side = MeshOf(context.surfaces.rail_side, chunk.ground);
  AppendSweep(stations, rest, side);
  if (range.begin_s_m == track.begin_s_m()) AppendRailEnd(stations.front(), section, false, side);
  if (range.end_s_m == track.end_s_m()) AppendRailEnd(stations.back(), section, true, side);
}

void AddSleepers(const ChunkContext& context,
                 std::size_t index,
                 const InfrastructureModels& models,
                 Chunk& chunk) {
  const std::shared_ptr<const Model>& model =
      context.spec.tracks[index].sleeper == SleeperType::kConcrete ? models.concrete_sleeper
                                                                   : models.wood_sleeper;
  const TrackCourse& track = context.tracks[index];
  // One step beyond the chunk on either side, so that rounding neither loses nor duplicates a
  // sleeper.
  const auto first = static_cast<std::int64_t>(std::floor(context.begin_s_m / kSleeperSpacing_m));
  const auto last = static_cast<std::int64_t>(std::ceil(context.end_s_m / kSleeperSpacing_m));
  for (std::int64_t k = first; k <= last; ++k) {
    const double s_m = static_cast<double>(k) * kSleeperSpacing_m;
    if (s_m < context.begin_s_m || s_m >= context.end_s_m) continue;
    if (s_m < track.begin_s_m() || s_m > track.end_s_m()) continue;
    const Transform chunk_from_track =
        context.chunk_from_world * track.WorldFromTrack(context.alignment, s_m);
    chunk.placements.push_back(
        {.model = model, .chunk_from_model = Eigen::Affine3d(chunk_from_track), .instance = 0});
  }
}

}  // namespace

void AddTracks(const ChunkContext& context, const InfrastructureModels& models, Chunk& chunk) {
  const RailSection left = MakeRailSection(true);
  const RailSection right = MakeRailSection(false);
  for (std::size_t index = 0; index < context.tracks.size(); ++index) {
    const TrackCourse& track = context.tracks[index];
    AddSleepers(context, index, models, chunk);
    const ChainageRange range = SweptRange(context, track);
    // A shorter range is only the overlap with the chunk in which the track begins or ends.
    if (range.end_s_m - range.begin_s_m < kChunkOverlap_m) continue;
    AddRail(context, track, left, range, chunk);
    AddRail(context, track, right, range, chunk);
  }
  AddBallast(context, chunk);
}

}  // namespace railcast
