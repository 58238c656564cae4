#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <string_view>
#include <vector>

#include "core/extras/ros/messages/message_type.h"

// Messages of ROS 2's package rmw_dds_common, by which participants tell the names of their nodes
// on the topic `ros_discovery_info`. `kFields` as in geometry_messages.h.

namespace railcast::ros {

/// The length of a Gid: 24 bytes up to Humble, of which the last 8 are 0; since Iron 16, that of a
/// DDS GUID.
inline constexpr std::size_t kGidSize = 16;
inline constexpr std::size_t kHumbleGidSize = 24;

template <std::size_t kSize>
struct Gid {
  static constexpr std::string_view kName = "rmw_dds_common/msg/Gid";
  static constexpr std::array kFields = {"data"};
  std::array<std::uint8_t, kSize> data{};  ///< `char` in the .msg file, which is uint8 in IDL.

  bool operator==(const Gid&) const = default;
};

template <std::size_t kSize>
struct NodeEntitiesInfo {
  static constexpr std::string_view kName = "rmw_dds_common/msg/NodeEntitiesInfo";
  static constexpr std::array kFields = {"node_namespace", "node_name", "reader_gid_seq",
                                         "writer_gid_seq"};
  BoundedString<256> node_namespace;  ///< "/"
  BoundedString<256> node_name;
  std::vector<Gid<kSize>> reader_gid_seq;
  std::vector<Gid<kSize>> writer_gid_seq;

  bool operator==(const NodeEntitiesInfo&) const = default;
};

template <std::size_t kSize = kGidSize>
struct ParticipantEntitiesInfo {
  static constexpr std::string_view kName = "rmw_dds_common/msg/ParticipantEntitiesInfo";
  static constexpr std::array kFields = {"gid", "node_entities_info_seq"};
  Gid<kSize> gid;  ///< Id of the participant.
  std::vector<NodeEntitiesInfo<kSize>> node_entities_info_seq;

  bool operator==(const ParticipantEntitiesInfo&) const = default;
};

}  // namespace railcast::ros
