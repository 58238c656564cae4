#pragma once

#include <cstdint>

#include "core/base/transform.h"
#include "core/rail/line/alignment.h"
#include "core/rail/rail_surfaces.h"
#include "core/rail/world_spec.h"

namespace railcast {

/// Neighbouring chunks overlap by this much: exact seams between frames of their own leak beams
/// (measured: 4 to 6 % of beams aimed at a seam; none at 1 mm).
inline constexpr double kChunkOverlap_m = 1e-3;

/// What every builder of a chunk needs. Builders are pure functions of it.
struct ChunkContext {
  const WorldSpec& spec;
  const Alignment& alignment;
  const RailSurfaces& surfaces;
  std::uint64_t seed{};
  int chunk{};
  double begin_s_m{};  ///< Repeated things (sleepers, masts, trees) belong to the chunk with
  double end_s_m{};    ///< begin <= s < end; swept surfaces reach kChunkOverlap_m / 2 further.
  Transform chunk_from_world;
};

}  // namespace railcast
