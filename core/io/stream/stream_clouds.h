#pragma once

#include <pcl/PCLPointCloud2.h>

#include <optional>

#include "core/frame/frame.h"
#include "core/io/stream/received_frame.h"

namespace railcast {

/// The points that arrived as a cloud of one row, with the stream's own field names. The stamp is
/// in microseconds, as PCL has it; `seq` is the frame number, `frame_id` "railcast_<sensor>".
[[nodiscard]] pcl::PCLPointCloud2 MakePclCloud(const ReceivedFrame& received);

/// The sender's frame; fields that were not sent are NaN or 0.
///
/// Nothing unless every slot was sent and arrived, with the fields that say what it is: ring,
/// column, outcome, and return_index where a firing has several slots.
[[nodiscard]] std::optional<Frame> MakeFrame(const ReceivedFrame& received);

}  // namespace railcast
