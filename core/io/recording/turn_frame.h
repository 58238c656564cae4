#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "core/io/sensor_turn.h"
#include "railcast/io/recording.h"
#include "railcast/lidar.h"

namespace railcast {

/// The meaning of a spinning sensor's intensity bytes.
enum class IntensityBytes {
  kVelodyne,  ///< Reflectivity as defined in reflectivity.h.
  kPercent
};

/// The rows of a sensor's frames.
struct TurnShape {
  std::vector<std::int64_t> row_time_ns;  ///< Firing time of each row since its cycle began.
  IntensityBytes intensity{};
};

/// Gives the rows by rising elevation.
[[nodiscard]] TurnShape ShapeOfTurns(const std::vector<ChannelSpec>& channels,
                                     IntensityBytes intensity);

/// Makes a grid of a turn: one column for each firing cycle that the turn holds, two slots per
/// firing if the turn is dual, and a slot without a point where a laser's distance was 0. Times are
/// known unless the sensor's clock jumped during the turn.
[[nodiscard]] RecordedFrame MakeTurnFrame(const SensorTurn& turn,
                                          const TurnShape& shape,
                                          const std::string& name);

}  // namespace railcast
