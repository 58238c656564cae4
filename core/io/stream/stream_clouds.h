#pragma once

#include <optional>

#include "core/io/cloud/cloud.h"
#include "railcast/frame.h"
#include "railcast/io/stream.h"

namespace pcl {
struct PCLPointCloud2;
}

namespace railcast {

/// Makes a cloud of one row of the points that arrived, with the stream's own field names.
[[nodiscard]] Cloud MakeCloud(const ReceivedFrame& received);

/// As MakeCloud(). The stamp is in microseconds, as PCL defines it; `seq` is the frame number,
/// `frame_id` "railcast_<sensor>".
[[nodiscard]] pcl::PCLPointCloud2 MakePclCloud(const ReceivedFrame& received);

/// Restores the sender's frame; fields that were not sent are NaN or 0.
///
/// Returns nothing unless every slot was sent and arrived, with the fields that identify it: ring,
/// column, outcome, and return_index where a firing has several slots.
[[nodiscard]] std::optional<Frame> MakeFrame(const ReceivedFrame& received);

}  // namespace railcast
