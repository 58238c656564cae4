#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <vector>

struct ddsi_serdata;
struct ddsi_sertype;

namespace railcast::dds {

// A type of Cyclone DDS whose samples are the bytes of messages as they are on the wire. So one
// encoder serves DDS and files, and no code is generated from IDL. This is the way in which ROS 2's
// own layer over Cyclone DDS brings its messages there.

/// Makes a type; dds_create_topic_sertype() takes it over.
/// @param name As DDS writes it: "sensor_msgs::msg::dds_::PointCloud2_".
[[nodiscard]] ddsi_sertype* MakeRawType(const std::string& name);

/// Makes a sample; dds_writecdr() takes it over.
/// @param type As the topic has it.
[[nodiscard]] ddsi_serdata* MakeRawSample(const ddsi_sertype* type, std::span<const std::byte> cdr);

/// The bytes of a sample that dds_takecdr() returned, with up to three bytes of padding.
/// @pre It belongs to a type of MakeRawType().
[[nodiscard]] const std::vector<std::byte>& BytesOf(const ddsi_serdata* sample);

}  // namespace railcast::dds
