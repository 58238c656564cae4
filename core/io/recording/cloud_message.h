#pragma once

#include "core/io/cloud/point_table.h"
#include "core/io/ros/sensor_messages.h"

namespace railcast {

/// Takes the points of a message as a table: fields by name, type and offset as the message says,
/// of either byte order.
/// @throws InputError "rule (got value)" if the message contradicts itself.
[[nodiscard]] PointTable MakePointTable(const ros::PointCloud2& cloud);

}  // namespace railcast
