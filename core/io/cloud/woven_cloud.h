#pragma once

#include <cstddef>

#include "core/io/cloud/cloud.h"
#include "core/io/cloud/track_fields.h"
#include "railcast/frame.h"

namespace railcast {

/// Describes a frame's points as a cloud, without the data: organised, each point packed, the types
/// those of the frame.
[[nodiscard]] Cloud DescribeCloud(const Frame& frame, const SelectedFields& fields);

/// Writes the fields interleaved, point by point.
/// @param step Bytes of a point: point_step of DescribeCloud().
/// @pre `to` has room for num_slots() * step bytes.
void WeaveRows(const Frame& frame, const SelectedFields& fields, std::size_t step, char* to);

}  // namespace railcast
