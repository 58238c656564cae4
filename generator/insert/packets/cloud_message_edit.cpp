#include "generator/insert/packets/cloud_message_edit.h"

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>

#include "core/io/cloud/cloud_rows.h"
#include "core/io/recording/cloud_message.h"
#include "core/io/ros/cdr.h"
#include "generator/insert/clouds/edit_rows.h"

namespace railcast {
namespace {

CloudRows RowsOf(const ros::PointCloud2& cloud) {
  CloudRows rows{.table = MakePointTable(cloud),
                 .cells = {},
                 .bytes = {},
                 .row_bytes = cloud.point_step,
                 .num_words = 0,
                 .line_begins = {}};
  rows.bytes = rows.table.bytes;
  for (const PointColumn& column : rows.table.columns) {
    rows.cells.push_back({column.type, column.offset});
  }
  return rows;
}

/// Puts rows of points into an organised message, which keeps what stands between its rows.
void PutRows(const std::string& points, ros::PointCloud2& cloud) {
  const std::size_t row_size = std::size_t{cloud.width} * cloud.point_step;
  for (std::size_t row = 0; row < cloud.height; ++row) {
    std::copy_n(points.begin() + static_cast<std::ptrdiff_t>(row * row_size), row_size,
                cloud.data.begin() + static_cast<std::ptrdiff_t>(row * cloud.row_step));
  }
}

}  // namespace

EditedCloudMessage EditCloudMessage(std::span<const std::byte> data,
                                    const RecordedFirings& firings,
                                    const InsertedFrame& inserted) {
  auto cloud = ros::FromCdr<ros::PointCloud2>(data);
  EditedRows edited = EditRows(RowsOf(cloud), firings, inserted, {});
  cloud.is_bigendian = false;
  const bool has_lost = std::ranges::any_of(
      inserted.edits, [](const SlotEdit& edit) { return edit.had_point && !edit.has_point; });
  if (edited.slots.size() == std::size_t{cloud.width} * cloud.height) {
    PutRows(edited.bytes, cloud);
    // Absent points are NaN.
    cloud.is_dense = cloud.is_dense && !(has_lost && cloud.height > 1);
    return {ros::ToCdr(cloud), std::move(edited.slots)};
  }
  cloud.height = 1;
  cloud.width = static_cast<std::uint32_t>(edited.slots.size());
  cloud.row_step = cloud.width * cloud.point_step;
  cloud.data.assign(edited.bytes.begin(), edited.bytes.end());
  return {ros::ToCdr(cloud), std::move(edited.slots)};
}

}  // namespace railcast
