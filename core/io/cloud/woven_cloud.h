#pragma once

#include <pcl/PCLPointCloud2.h>
#include <cstddef>

#include "railcast/frame.h"
#include "railcast/io/cloud_files.h"

namespace railcast {

/// Describes a frame's points as a cloud, without the data: organised, each point packed, the types
/// those of the frame.
[[nodiscard]] pcl::PCLPointCloud2 DescribeCloud(const Frame& frame,
                                                const FieldSelection& selection);

/// Writes the fields interleaved, point by point.
/// @param step Bytes of a point: point_step of DescribeCloud().
/// @pre `to` has room for num_slots() * step bytes.
void WeaveRows(const Frame& frame, const FieldSelection& selection, std::size_t step, char* to);

}  // namespace railcast
