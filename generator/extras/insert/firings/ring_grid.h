#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "core/io/recording/scan_table.h"
#include "railcast/lidar.h"

namespace railcast {

/// The columns of a whole turn.
struct TurnColumns {
  std::vector<std::uint32_t> of_old;  ///< For each column of the grid.
  std::vector<double> azimuth_rad;    ///< To the left, unwrapped.
  double step_rad{};                  ///< Signed.
};

/// Whether the sensor fires with its rotor at this azimuth, counted in the sense of rotation, or
/// less than `margin_deg` beside.
[[nodiscard]] bool IsInWindow(const SpinningSpec& sensor, double rotor_deg, double margin_deg);

/// Gives the columns of a grid their places among those of the turn, where gaps have the columns
/// that fit.
/// @param left 1 if the rotor turns to the left, -1 if to the right.
[[nodiscard]] TurnColumns ColumnsOfTurn(const SpinningSpec& sensor,
                                        double left,
                                        const ScanTable& table);

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
