#pragma once

#include "core/io/recording/recording.h"
#include "viewer/overlays/drawing.h"
#include "viewer/overlays/surroundings.h"

namespace railcast {

inline constexpr double kGaugeBehind_m = 10.0;
inline constexpr double kGaugeAhead_m = 150.0;

/// GaugeOutline() along the vehicle's track, as far as the track is there, from 10 m behind the
/// vehicle to 150 m ahead: rings at every 10 m of chainage and the corners' edges between,
/// following curves to 5 mm and leaning with the cant. Empty if the frame has no pose.
[[nodiscard]] Drawing DrawStructureGauge(const Surroundings& surroundings,
                                         const RecordedFrame& recorded);

}  // namespace railcast
