#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "core/detect/detect_spec.h"
#include "core/scan/scan_pattern.h"
#include "core/trace/ray_tile.h"

namespace railcast {

/// Which beams one ray cannot stand for: those whose neighbours' central rays do not lie on the
/// plane that their own has hit. Neighbours are the next firings of the grid, or those half a
/// beam's width away where firings stand closer.
class SubRayNeeds {
 public:
  /// @param everywhere Effect dense_footprint: every beam.
  SubRayNeeds(const ScanPattern& pattern, const BeamSpec& beam, bool everywhere);

  /// Sets marks[lane] to 1 or 0 for the lanes of a tile.
  /// @param centers The frame's central rays, traced, by tile.
  void Mark(std::size_t tile, const std::vector<RayTile>& centers, std::uint8_t* marks) const;

 private:
  static constexpr std::size_t kNumNeighbours = 8;
  bool everywhere_;
  /// For every traced lane of every tile: where its neighbours are traced; its own place where it
  /// has none.
  std::vector<std::uint32_t> neighbours_;
};

}  // namespace railcast
