#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "core/io/dds/participant.h"
#include "core/io/ros/discovery_messages.h"

namespace railcast::dds {

using EntityGid = ros::Gid<ros::kGidSize>;

/// The topic on which ROS 2's participants tell the names of their nodes; it has no leading "/".
[[nodiscard]] TopicSpec NodesTopic();

/// The message of a participant with one node, as ROS 2 reads it since Iron. Humble's has longer
/// ids: there `ros2 node list` does not show the node, and `ros2 topic` shows all.
[[nodiscard]] std::vector<std::byte> NodesMessage(const EntityGid& participant,
                                                  const std::string& node,
                                                  const std::vector<EntityGid>& writers,
                                                  const std::vector<EntityGid>& readers);

}  // namespace railcast::dds
