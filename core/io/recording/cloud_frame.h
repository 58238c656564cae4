#pragma once

#include <string>

#include "core/io/recording/point_table.h"
#include "core/io/recording/recording.h"
#include "core/scan/scan_pattern.h"

namespace railcast {

/// A frame from the points of a file, in the axes in which they are stored.
///
/// An organised cloud is a grid as it is; with the rows by rising mean elevation if its ring
/// numbers are not ours. Points with our ring and column go to their slots. Others go into a
/// ring/azimuth table (ring_table.h) if one can be made; if not, the frame has one row of points
/// and is no grid.
///
/// A time is taken under another's name (t, time, timestamp, time_stamp) only if its unit is
/// certain: floating point that spans 0.02 to 1 s, as scans do, or integers that span as many
/// nanoseconds.
///
/// @param name For messages.
/// @throws InputError with one line if x, y or z is missing, a value does not fit its field, or two
///   points say that they are of one slot.
[[nodiscard]] RecordedFrame MakeCloudFrame(const PointTable& table, const std::string& name);

/// A frame of ours, of which the scan is known: every firing has its slots, and ring, column and
/// time_ns also where the file has points only. Such a file without ring or column is no grid.
/// @param is_organised Whether the file has every slot.
/// @throws InputError likewise, or if the file does not have the scan's shape.
[[nodiscard]] RecordedFrame MakeScanFrame(const PointTable& table,
                                          const std::string& name,
                                          const ScanPattern& pattern,
                                          bool is_organised);

}  // namespace railcast
