#pragma once

#include <cstddef>
#include <vector>

#include "core/trace/beam_tree.h"
#include "railcast/ray_caster.h"

namespace railcast {

/// Beams that are traced together: the neighbours that make a packet of central rays.
inline constexpr std::size_t kBeamsOfTile = 16;

/// A way of tracing the beams of a tile.
struct BeamWay {
  const char* name;
  void (*trace)(const BeamScene& scene, BeamRays* beams, std::size_t num);
};

/// The first only aims, the second is the product's.
[[nodiscard]] std::vector<BeamWay> BeamWays();

}  // namespace railcast
