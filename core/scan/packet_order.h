#pragma once

#include <cstdint>
#include <vector>

#include "core/scan/firing.h"

namespace railcast {

/// Which firings share a packet (see ScanPattern::packet_order): every index of `grid.firings`
/// once, the last packet filled up with its last firing.
///
/// Firings are ordered by elevation and cut into bands about as high as the square that 16 firings
/// cover on average: of whole rows where the pattern is a grid (4 rows of an even raster, 1 to 3 of
/// a spinning sensor, whose channels stand wider apart than its columns). Each band is ordered by
/// azimuth, to the left and to the right in turn, and the chain of all bands is cut into packets.
/// So every packet is full, even where no block of whole rows and columns would fit, and compact,
/// even where channels of one column look several degrees apart in azimuth.
[[nodiscard]] std::vector<std::uint32_t> PacketOrder(const FiringGrid& grid);

}  // namespace railcast
