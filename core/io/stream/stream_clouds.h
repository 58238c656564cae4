#pragma once

#include "core/io/cloud/cloud.h"
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

}  // namespace railcast
