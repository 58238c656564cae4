#pragma once

#include <vector>

#include "core/rail/chunk/chunk_context.h"
#include "core/rail/chunk/sweep.h"
#include "core/rail/structures/crossing_road.h"
#include "railcast/structures.h"

namespace railcast {

/// The floors of structures on which persons and things may stand, along a stretch of the line: the
/// roads of level crossings and the tops of platforms.
class Floors {
 public:
  Floors(const ChunkContext& context, const ChainageRange& range);

  /// The height of the highest floor at a place, in the world; minus infinity where there is none.
  /// `d_m` is left of the alignment.
  [[nodiscard]] double HeightAt_m(double s_m, double d_m) const;

 private:
  const ChunkContext* context_;
  std::vector<CrossingRoad> roads_;
  std::vector<const PlatformSpec*> platforms_;
};

}  // namespace railcast
