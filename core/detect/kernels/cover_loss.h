// See vector_math.h for why this header has no `#pragma once`.
#ifndef RAILCAST_DETECT_COVER_LOSS_H_
#define RAILCAST_DETECT_COVER_LOSS_H_

#include "core/detect/base/detect_tile.h"
#include "railcast/outcome.h"

namespace railcast::RAILCAST_ISA {

/// Effect `cover`, before detection: every echo, also one from the air, loses the light that the
/// spots on the window keep back (cover.h).
inline void ApplyCoverLoss(DetectTile& tile) {
  for (std::size_t i = 0; i < tile.num_rays; ++i) {
    const float ratio = tile.power_ratio[i];
    tile.bare_ratio[i] = ratio;
    tile.power_ratio[i] = ratio * tile.cover[i];
  }
}

/// Effect `cover`, after detection: an echo that is too weak, but would not be behind a clean
/// window, is lost to the window.
inline void BlameCover(DetectTile& tile) {
  constexpr auto kBelowThreshold = static_cast<std::uint32_t>(Outcome::kBelowThreshold);
  constexpr auto kCoverBlocked = static_cast<std::uint32_t>(Outcome::kCoverBlocked);
  for (std::size_t i = 0; i < tile.num_rays; ++i) {
    const std::uint32_t before = tile.outcome[i];
    const bool is_to_blame =
        (before == kBelowThreshold) & (tile.cover[i] < 1.0F) & (tile.bare_ratio[i] >= 1.0F);
    tile.outcome[i] = is_to_blame ? kCoverBlocked : before;
  }
}

}  // namespace railcast::RAILCAST_ISA

#endif  // RAILCAST_DETECT_COVER_LOSS_H_
