#pragma once

#include <cstdint>
#include <vector>

#include "core/scan/scan_spec.h"

namespace railcast {

/// The row of each channel: its rank in elevation, from the lowest. Equals keep their order.
[[nodiscard]] std::vector<std::uint16_t> RowsByElevation(const std::vector<ChannelSpec>& channels);

}  // namespace railcast
