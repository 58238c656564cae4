#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "core/io/cloud/cloud.h"
#include "railcast/io/recording.h"
#include "railcast/lidar.h"

namespace railcast {

/// Makes a frame of the points of a file, in the axes in which they are stored.
///
/// An organised cloud is taken as a grid; if it does not have our fields ring and column, its rows
/// are sorted by rising mean elevation. An unorganised cloud with our ring and column has its
/// points put into their slots. Other clouds go into a ring/azimuth table (ring_table.h) if one can
/// be made; if not, the frame has one row of points and is not a grid.
///
/// A time field of another name (t, time, timestamp, time_stamp, gps_time) is used only if its unit
/// is certain: floating-point values that span 0.02 to 1 s, as scans do, or values that span as
/// many nanoseconds.
///
/// @param name Names the frame in messages.
/// @param why_no_ranges As in RecordedFrame; unless it is empty, the frame is not a grid.
/// @throws InputError with one line if x, y or z is missing, the positions cannot be metres
///   (CheckPositions()), a value does not fit its field, or two points claim the same slot.
[[nodiscard]] RecordedFrame MakeCloudFrame(const Cloud& cloud,
                                           const std::string& name,
                                           const std::string& why_no_ranges = {});

/// The column of times of a cloud that has no time_ns.
struct TimeColumn {
  const CloudField* column{};
  double first_ns{};     ///< The earliest time of a point.
  double ns_per_unit{};  ///< Unit of the stored numbers.

  /// What is stored for a time since the earliest.
  [[nodiscard]] double Stored(std::uint32_t since_first_ns) const {
    return (first_ns + since_first_ns) / ns_per_unit;
  }
};

/// Returns the column from which MakeCloudFrame() takes times since the earliest, if there is one.
[[nodiscard]] std::optional<TimeColumn> FindTimeColumn(const Cloud& cloud);

/// Returns the earliest time of a point, as stored, of a cloud from whose column of times
/// MakeCloudFrame() takes the times since then; nothing if it takes none.
[[nodiscard]] std::optional<double> FirstTimeIn_ns(const Cloud& cloud);

/// Makes a frame of a file that railcast wrote and whose scan pattern is known: every firing has
/// its slots, and ring, column and time_ns are known even where the file holds only returned
/// points. Such a file without ring or column is not a grid.
/// @param is_organised Whether the file has every slot.
/// @throws InputError as MakeCloudFrame(), or if the file does not have the scan's shape.
[[nodiscard]] RecordedFrame MakeScanFrame(const Cloud& cloud,
                                          const std::string& name,
                                          const ScanPattern& pattern,
                                          bool is_organised);

}  // namespace railcast
