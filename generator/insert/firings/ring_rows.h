#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "railcast/lidar.h"

namespace railcast {

/// A row of a recorded grid.
struct RecordedRow {
  double elevation_rad{};    ///< Median of its points; meaningless without any.
  std::size_t num_points{};  ///< In any of its columns.
};

/// Finds the channel of each row: rows and channels both rise in elevation, and the sum of what
/// they differ by is the least possible.
/// @param elevations_rad Of the sensor's channels, rising.
/// @returns For each row the index of its channel, or kNoSlot for a row without points that is none
///   of them.
/// @throws InputError with the reason, in numbers, if the rows are not those of the sensor.
[[nodiscard]] std::vector<std::uint32_t> ChannelsOfRows(std::span<const RecordedRow> rows,
                                                        std::span<const double> elevations_rad);

}  // namespace railcast
