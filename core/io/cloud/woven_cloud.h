#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

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

/// Copies values stored field by field, each for all rows, to rows, or back.
/// @param field_bytes Of each field in a row.
void Transpose(const std::vector<std::size_t>& field_bytes,
               std::size_t num_rows,
               std::string_view from,
               bool is_to_rows,
               std::string& to);

}  // namespace railcast
