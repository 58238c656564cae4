#pragma once

#include <cstddef>
#include <optional>

#include "core/io/recording/scan_table.h"
#include "railcast/frame.h"
#include "railcast/transform.h"

namespace railcast {

/// The first return of a firing, in the sensor's axes; nothing if there is none or no such firing.
[[nodiscard]] std::optional<Vector3> FirstPointAt(const Frame& frame,
                                                  std::size_t row,
                                                  std::size_t column);

/// Unit normal, of either sign, of the surface about a firing's point: across the lines through its
/// neighbours in its ring and in the rings above and below, the nearest ones that are at least
/// 15 cm + 1 % of the range away. Zero where there are none, or where the point is no nearer than
/// 26 deg to being in line with them, as at edges and in plants.
/// @pre The firing has a point.
[[nodiscard]] Vector3 LocalNormal(const Frame& frame,
                                  const ScanTable& scan,
                                  std::size_t row,
                                  std::size_t column);

}  // namespace railcast
