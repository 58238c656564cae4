#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

#include "core/rail/base/rail_surfaces.h"
#include "core/rail/line/track_course.h"
#include "core/rail/network/junction_rails.h"
#include "core/rail/network/world_tracks.h"
#include "railcast/alignment.h"
#include "railcast/transform.h"
#include "railcast/world_spec.h"

namespace railcast {

class ClearedAreas;
class Landform;
class SurveyedScene;

/// Overlap of neighbouring chunks. Each chunk has a frame of its own, so an exact seam would leak
/// beams: 0.4 % of those aimed at it were measured to pass, and none with this overlap
/// (docs/results/accuracy.md).
inline constexpr double kChunkOverlap_m = 1e-3;

/// How many coarser forms ballast, ground and rails have. The coarsest is for what no firing meets.
inline constexpr std::size_t kMostCoarse = 2;

/// Input of every chunk builder. Builders are pure functions of it.
struct ChunkContext {
  const WorldSpec& spec;
  const Alignment& alignment;
  std::span<const TrackCourse> tracks;  ///< In the order of WorldSpec::tracks.
  std::span<const LaidTurnout> turnouts;
  const RailSurfaces& surfaces;
  std::uint64_t seed{};
  int chunk{};
  /// Repeated elements (sleepers, masts, trees) belong to the chunk with begin <= s < end.
  double begin_s_m{};
  double end_s_m{};  ///< Swept surfaces extend kChunkOverlap_m / 2 beyond either end.
  Transform chunk_from_world;
  /// How coarse ballast, ground and rails are built (docs/results/detail.md), at most kMostCoarse.
  /// All forms begin and end with the same points as the finest one.
  std::size_t level = 0;
  /// The shape of the land; null: as high as the formation, and equally wide everywhere.
  const Landform* land = nullptr;
  std::span<const LaidDiamond> diamonds{};
  /// Where structures take the place of ballast, known for some range of chainages; null: looked up
  /// for each place.
  const ClearedAreas* unballasted = nullptr;
  const SurveyedScene* survey = nullptr;  ///< What is surveyed instead of built; null: nothing.
};

[[nodiscard]] inline WorldTracks TracksOf(const ChunkContext& context) {
  return {context.spec, context.tracks};
}

}  // namespace railcast
