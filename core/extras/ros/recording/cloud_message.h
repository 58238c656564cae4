#pragma once

#include <cstddef>
#include <cstdint>

#include "core/extras/ros/messages/sensor_messages.h"
#include "core/extras/ros/recording/packet_messages.h"
#include "core/io/cloud/cloud.h"

namespace railcast {

/// Bytes from one row of a message to the next: what it states, unless its data are rows without
/// anything between them; then some drivers state 0 or anything else.
[[nodiscard]] std::size_t RowStepOf(const ros::PointCloud2& message);

/// Takes the points of a message: fields by name, type and offset as the message says, of either
/// byte order. Where coordinates are such in the other order only, that one is taken. That, and
/// points beyond the width and height that the message states, are its remarks.
/// @throws InputError "rule (got value)" if the message contradicts itself.
[[nodiscard]] Cloud MakeCloud(ros::PointCloud2 message);

/// Takes the points of a message of Livox: x, y, z, reflectivity, tag, line, and time_ns since the
/// first of them.
/// @param first_ns Becomes the offset_time of that one.
/// @throws InputError as above.
[[nodiscard]] Cloud MakeCloud(const ros::LivoxCloud& message, std::int64_t& first_ns);

/// When the first point of a message was measured.
struct FirstPointTime {
  double since_stamp_ns{};
  /// Not if it is farther from the stamp than the frame is long: then it is none since the stamp,
  /// nor on its clock.
  bool is_certain{};
};

/// @param first_ns As stored: since the stamp or, where these are nearer, as the stamp counts.
[[nodiscard]] FirstPointTime FirstPointTimeOf(std::int64_t stamp_ns,
                                              double first_ns,
                                              std::uint32_t duration_ns);

}  // namespace railcast
