#pragma once

#include <optional>

#include "core/rail/line/network.h"
#include "core/rail/world_faults.h"
#include "railcast/alignment.h"

namespace railcast {

/// Checks the courses of the tracks that are not parallel to the alignment: offsets within the
/// ground's half width, radii of at least kSmallestRadius_m, and at least kLeastTrackDistance_m
/// from every other track. Tracks that a turnout joins may be closer from its beginning to where
/// the branch has got that far, and so may all tracks that such turnouts join there; and tracks
/// that cross, which must be without cant there.
/// @param alignment Absent if unknown; radii are not checked then.
void CheckNetwork(const WorldSpec& world,
                  const NetworkDraft& network,
                  const std::optional<Alignment>& alignment,
                  WorldFaults& faults);

}  // namespace railcast
