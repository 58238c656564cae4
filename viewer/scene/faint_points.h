#pragma once

#include <cstdint>
#include <set>
#include <vector>

#include "viewer/frames/shown_frame.h"

namespace railcast {

/// Of each point whether it is of none of the labels that were selected; empty without a selection.
[[nodiscard]] std::vector<bool> FaintPoints(const ShownFrame& shown,
                                            const std::set<std::uint32_t>& labels);

}  // namespace railcast
