#pragma once

#include "core/rail/base/world_faults.h"
#include "core/rail/network/network.h"
#include "railcast/world_spec.h"

namespace railcast {

/// Makes what can be made of a network and adds all faults found in doing so. Values that `faults`
/// marks as unknown are skipped.
/// @param length_m Of the line; may be infinite.
[[nodiscard]] NetworkDraft DraftNetwork(const WorldSpec& world,
                                        double length_m,
                                        WorldFaults& faults);

/// @throws InputError with the faults that DraftNetwork() finds.
[[nodiscard]] Network MakeNetwork(const WorldSpec& world, double length_m);

/// @pre The draft was made without faults.
[[nodiscard]] Network Completed(NetworkDraft draft);

}  // namespace railcast
