#pragma once

#include <cstddef>

#include "core/detect/base/detect_tile.h"
#include "railcast/outcome.h"

namespace railcast {

/// Whether an echo is that of a retroreflector: a detectable surface brighter than white paper.
[[nodiscard]] inline bool IsRetroreflected(const DetectTile& tile,
                                           std::size_t lane,
                                           float range_min_m) {
  return tile.intensity[lane] > 1.0F && tile.power_ratio[lane] > 1.0F &&
         tile.true_range_m[lane] >= range_min_m &&
         tile.outcome[lane] == static_cast<std::uint32_t>(Outcome::kReturned) &&
         tile.clutter[lane] == kNoClutter;
}

}  // namespace railcast
