#pragma once

#include <cstdint>
#include <string>

#include "core/extras/ros/messages/sensor_messages.h"
#include "core/io/cloud/cloud.h"
#include "railcast/io/cloud_files.h"

namespace railcast {

/// Whether files or messages of a format can hold a field: those of PLY and of bags have no
/// integers of 64 bits, those of PLY one number a field, and files names that are words.
[[nodiscard]] bool Holds(const FrameFormat& format, const CloudField& field);

/// The rows of an organised cloud that are stored neither in fields nor in files without rows.
[[nodiscard]] std::uint64_t NumRowsAlone(const Cloud& cloud);

/// Leaves out the points without a position, and with them the rows of an organised cloud.
/// @pre The cloud has positions.
/// @return How many there were.
std::uint64_t DropAbsentPoints(Cloud& cloud);

/// Encodes a cloud as a PCD or PLY file, each field in its own type but for the flavour
/// ply-cloudcompare, which has int, float and double.
/// @pre The format is one of these, and holds all fields, which are packed.
[[nodiscard]] std::string EncodeCloud(const Cloud& cloud, const FrameFormat& format);

/// The message that holds a cloud.
[[nodiscard]] ros::PointCloud2 MessageOf(Cloud cloud, ros::Header header);

}  // namespace railcast
