#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "generator/extras/insert/firings/frame_slots.h"
#include "railcast/io/recording.h"
#include "railcast/lidar.h"

namespace railcast {

/// The firing of each cell of a pattern (row * columns + column); kNoSlot where it does not fire.
[[nodiscard]] std::vector<std::uint32_t> FiringsOfCells(const ScanPattern& pattern);

/// Finds the cells of the frame of a scan whose firings are known exactly: of railcast's own
/// frames, by the rows and columns that they state, or, if they state none, by following the scan
/// from point to point in the order of the file, in which railcast writes them. The sensor's motion
/// may be undone (PointAxes::kSensorAtStamp) if its poses are known. Rows and columns may be those
/// of points with noise across their beams; what is followed must lie on them.
/// @param pattern That of this frame.
/// @param is_own_scan Whether it is known that rows and columns are those of the pattern.
/// @returns Nothing if the points do not lie on the beams of the pattern. A frame without points
///   fits if it has the pattern's shape.
[[nodiscard]] std::optional<NewSlots> FitToScan(const ScanPattern& pattern,
                                                const std::vector<std::uint32_t>& firing_of_cell,
                                                const RecordedFrame& recorded,
                                                bool is_own_scan);

}  // namespace railcast
