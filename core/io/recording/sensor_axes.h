#pragma once

#include "core/base/transform.h"
#include "core/frame/output_spec.h"
#include "core/io/recording/recording.h"
#include "core/scan/scan_pattern.h"

namespace railcast {

/// Puts the points of a frame of ours back into the sensor's axes from those that the scenario
/// asked for: undoes OutputAxes (core/simulate/output_axes.h). World coordinates take the pose at
/// each firing's own time, as ScanMotion interpolates it: 2.5 mm off in the middle of a scan of 0.1
/// s at an acceleration of 2 m/s^2. range_m is left as it is.
/// @param pattern Knows the times of a grid's firings where the file has none.
/// @throws InputError "name: rule" if world coordinates come without times.
void UndoOutputAxes(const OutputSpec& output,
                    const Transform& vehicle_from_sensor,
                    const ScanPattern& pattern,
                    RecordedFrame& recorded);

}  // namespace railcast
