#pragma once

#include <pcl/PCLPointCloud2.h>
#include <cstddef>
#include <string>

#include "core/io/cloud/track_fields.h"
#include "railcast/frame.h"

namespace railcast {

/// Describes a frame's points as a cloud, without the data: organised, each point packed, the types
/// those of the frame.
[[nodiscard]] pcl::PCLPointCloud2 DescribeCloud(const Frame& frame, const SelectedFields& fields);

/// Writes the fields interleaved, point by point.
/// @param step Bytes of a point: point_step of DescribeCloud().
/// @pre `to` has room for num_slots() * step bytes.
void WeaveRows(const Frame& frame, const SelectedFields& fields, std::size_t step, char* to);

/// Appends the data of a PCD file of encoding binary_compressed: both sizes and the LZF of `plain`.
/// @param plain Each field for all points, one field after another.
void AppendCompressed(const std::string& plain, std::string& bytes);

}  // namespace railcast
