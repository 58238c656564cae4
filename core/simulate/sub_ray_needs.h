#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "railcast/effects.h"
#include "railcast/lidar.h"
#include "railcast/ray_caster.h"

namespace railcast {

/// Selects the beams that a single ray cannot represent: those where the central ray of a neighbour
/// does not hit the plane that their own central ray hit. Neighbours are adjacent firings of the
/// grid or, if firings are closer than that, those half a beam's width away.
class SubRayNeeds {
 public:
  /// @param everywhere Select every beam (effect dense_footprint).
  SubRayNeeds(const ScanPattern& pattern, const BeamSpec& beam, bool everywhere);

  /// Sets marks[lane] to 1 (selected) or 0 for the lanes of a tile.
  /// @param centers The frame's traced central rays, by tile.
  void Mark(std::size_t tile, const std::vector<RayTile>& centers, std::uint8_t* marks) const;

 private:
  static constexpr std::size_t kNumNeighbours = 8;
  bool everywhere_;
  /// For every lane in tracing order: the lanes in which its neighbours are traced, or its own
  /// where it has no neighbour.
  std::vector<std::uint32_t> neighbours_;
};

}  // namespace railcast
