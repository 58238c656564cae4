#pragma once

#include <optional>
#include <string>
#include <vector>

#include "generator/extras/ros/ros_output.h"
#include "generator/live/live_streams.h"
#include "generator/live/stream_options.h"
#include "railcast/scenario.h"

namespace railcast {

/// Whether `--fields` names something that only protocol ros2 has: the fields of a sensor's driver.
[[nodiscard]] bool IsForRos(const std::string& fields);

/// What the sensors of protocol ros2 tell; nothing if there are none.
/// @throws InputError if the domain is none, or options do not go with the sensors' protocols.
[[nodiscard]] std::optional<RosOutputSpec> PlanRos(const StreamOptions& options,
                                                   const ScenarioSpec& scenario,
                                                   const std::vector<SensorStreamSpec>& streams);

}  // namespace railcast
