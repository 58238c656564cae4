#pragma once

#include <vector>

#include "generator/extras/insert/firings/given_firings.h"
#include "railcast/io/recording.h"
#include "railcast/lidar.h"

namespace railcast {

/// Finds the firings of a spinning sensor from a grid of its points, and gives the frame the shape
/// of all of them: a row for each channel, and the columns of the whole turn, or of the azimuth
/// window that the sensor has.
///
/// A firing with a point goes to this point. All others have the elevation of their ring, and the
/// azimuth of their column with the offset of their ring, both as the points show them
/// (ScanTable). Rings without any point have the elevation and azimuth of the sensor's table,
/// turned as the other rings are. Columns without any point are a step apart, as many as fit into
/// the gap. Times follow from the azimuths by the rotor's speed, shifted so that they agree with
/// those of the nearest points; without times in the recording, the first firing is at the stamp.
///
/// @throws InputError with the reason, in numbers, if the grid is not that of the sensor.
[[nodiscard]] std::vector<GivenFiring> FindRingFirings(const SpinningSpec& sensor,
                                                       double rate_hz,
                                                       RecordedFrame& recorded);

}  // namespace railcast
