#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "core/io/recording/recording.h"
#include "core/io/sensor_turn.h"
#include "core/scan/scan_spec.h"

namespace railcast {

/// What a spinning sensor's bytes for intensity mean.
enum class IntensityBytes {
  kVelodyne,  ///< Reflectivity as of reflectivity.h.
  kPercent
};

/// The rows of a sensor's frames.
struct TurnShape {
  std::vector<std::int64_t> row_time_ns;  ///< Firing of each row, since its cycle began.
  IntensityBytes intensity{};
};

/// Rows by rising elevation.
[[nodiscard]] TurnShape ShapeOfTurns(const std::vector<ChannelSpec>& channels,
                                     IntensityBytes intensity);

/// A turn as a grid: a column for each firing cycle that it holds, a slot without a point where a
/// laser's distance was 0, two slots if it is dual. Times are known unless the sensor's clock leapt
/// during the turn.
[[nodiscard]] RecordedFrame MakeTurnFrame(const SensorTurn& turn,
                                          const TurnShape& shape,
                                          const std::string& name);

}  // namespace railcast
