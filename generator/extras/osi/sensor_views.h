#pragma once

#include <cstddef>
#include <functional>
#include <string>

#include "generator/run/frame_maker.h"
#include "railcast/scenario.h"

namespace railcast {

/// Makes of a frame its serialized osi3.SensorView. Several threads may do so at once.
using SensorViewMaker = std::function<std::string(const MadeFrame& made)>;

/// @param maker Must outlive what is returned; commands come before the first frame.
/// @param scenario Reduced to the sensor (PickSensor()).
/// @param sensor Its index in `maker`.
[[nodiscard]] SensorViewMaker MakeSensorViews(const FrameMaker& maker,
                                              const ScenarioSpec& scenario,
                                              std::size_t sensor);

}  // namespace railcast
