#pragma once

#include "core/io/recording/recording.h"
#include "viewer/overlays/drawing.h"
#include "viewer/overlays/surroundings.h"

namespace railcast {

inline constexpr double kAxisBehind_m = 50.0;
inline constexpr double kAxisAhead_m = 400.0;

/// The axis of the vehicle's track at top of rail, as far as the track is there, from 50 m behind
/// the vehicle to 400 m ahead of it: a line within 5 mm of the axis in all curves of 25 m radius or
/// more, across it a tick at every 10 m of chainage, and a longer one at every 50 m, at whose left
/// end stands the chainage as railways write it, "km 12.350". Empty if the frame has no pose.
[[nodiscard]] Drawing DrawTrackAxis(const Surroundings& surroundings,
                                    const RecordedFrame& recorded);

}  // namespace railcast
