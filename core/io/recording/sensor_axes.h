#pragma once

#include "railcast/frame.h"
#include "railcast/io/recording.h"
#include "railcast/lidar.h"
#include "railcast/transform.h"

namespace railcast {

/// Moves the points of a frame that railcast made from the axes that the scenario asked for back
/// into the sensor's axes; undoes OutputAxes (core/simulate/output_axes.h). Points in world
/// coordinates use the pose at each firing's own time, as ScanMotion interpolates it. Leaves
/// range_m unchanged.
/// @param pattern Gives the firing times of a grid where the file has none.
/// @throws InputError "name: rule" if world coordinates come without times.
void UndoOutputAxes(const OutputSpec& output,
                    const Transform& vehicle_from_sensor,
                    const ScanPattern& pattern,
                    RecordedFrame& recorded);

/// Turns the points and poses of a frame into the axes about whose z its sensor spins, for what
/// only sensors that stand are made for; nothing remains of Frame::sensor_from_spin.
void TurnToSpinAxes(Frame& frame);

}  // namespace railcast
