#pragma once

#include <string_view>

#include "railcast/lidar.h"

namespace railcast {

/// The channels of a sensor in the order of its packets, and their cycle: the pattern of
/// scenarios/sensors/NAME.json, a copy of which is part of the program.
/// @param name One that core/io/CMakeLists.txt lists.
[[nodiscard]] SpinningSpec SensorTable(std::string_view name);

}  // namespace railcast
