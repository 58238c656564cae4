#pragma once

#include "core/io/cloud/cloud.h"
#include "core/io/ros/sensor_messages.h"

namespace railcast {

/// Takes the points of a message: fields by name, type and offset as the message says,
/// of either byte order.
/// @throws InputError "rule (got value)" if the message contradicts itself.
[[nodiscard]] Cloud MakeCloud(ros::PointCloud2 message);

}  // namespace railcast
