#include "core/io/dds/announced_node.h"

#include "core/io/ros/cdr.h"
#include "core/io/ros/message_type.h"

namespace railcast::dds {

TopicSpec NodesTopic() {
  const ros::MessageType& type = ros::TypeOf<ros::ParticipantEntitiesInfo<>>();
  return {
      .name = "ros_discovery_info", .type = type.dds_name, .hash = type.hash, .is_latched = true};
}

std::vector<std::byte> NodesMessage(const EntityGid& participant,
                                    const std::string& node,
                                    const std::vector<EntityGid>& writers,
                                    const std::vector<EntityGid>& readers) {
  ros::ParticipantEntitiesInfo<> info;
  info.gid = participant;
  info.node_entities_info_seq.push_back({.node_namespace = {"/"},
                                         .node_name = {node},
                                         .reader_gid_seq = readers,
                                         .writer_gid_seq = writers});
  return ros::ToCdr(info);
}

}  // namespace railcast::dds
