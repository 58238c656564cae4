#pragma once

#include <cstdint>
#include <set>
#include <vector>

#include "viewer/frames/shown_frame.h"

namespace railcast {

/// Says of each point whether its label is not among those selected; empty if none are selected.
[[nodiscard]] std::vector<bool> FaintPoints(const ShownFrame& shown,
                                            const std::set<std::uint32_t>& labels);

}  // namespace railcast
