#pragma once

#include <cstdint>
#include <vector>

#include "core/scan/firing.h"

namespace railcast {

/// Assigns firings to packets (see ScanPattern::packet_order): every index of `grid.firings` once,
/// with the last packet padded with its last firing.
///
/// Firings are sorted by elevation and cut into bands about as high as the square that 16 firings
/// cover on average. If the pattern is a grid, bands consist of whole rows: 4 rows of a uniform
/// raster, 1 to 3 rows of a spinning sensor, whose channels are spaced wider than its columns. Each
/// band is sorted by azimuth, alternately leftwards and rightwards, and the sequence of all bands
/// is cut into packets. Every packet is therefore full, even where blocks of whole rows and columns
/// would not fit, and compact, even if the channels of one column differ by several degrees in
/// azimuth.
[[nodiscard]] std::vector<std::uint32_t> PacketOrder(const FiringGrid& grid);

}  // namespace railcast
