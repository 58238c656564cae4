#include "core/io/recording/live_frame.h"

#include <algorithm>
#include <limits>

#include "core/io/recording/cloud_fields.h"
#include "core/io/recording/slot_plans.h"

namespace railcast {
namespace {

PointTable PointTableOf(const ReceivedFrame& received) {
  PointTable table{.width = static_cast<std::uint32_t>(received.num_points()),
                   .height = 1,
                   .columns = {},
                   .bytes = std::string(received.points.begin(), received.points.end())};
  for (const StreamField& field : received.header.fields) {
    table.columns.push_back({.name = field.name,
                             .type = static_cast<NumberType>(field.type),
                             .offset = field.offset,
                             .step = received.header.point_size});
  }
  return table;
}

/// Whether the slot of every point is known, and a slot without a point means a firing without a
/// return.
bool IsGrid(const ReceivedFrame& received) {
  const StreamHeader& header = received.header;
  if (!received.is_complete() || header.Find("ring") == nullptr ||
      header.Find("column") == nullptr ||
      (header.returns > 1 && header.Find("return_index") == nullptr)) {
    return false;
  }
  const std::uint64_t most = received.num_points() + kMaxSpareSlots;
  const std::uint64_t cells = std::uint64_t{header.rows} * header.columns;
  return cells <= most && cells * header.returns <= most;
}

SlotPlan PlanOfStream(const ReceivedFrame& received,
                      const PointTable& table,
                      const std::string& name) {
  if (!IsGrid(received)) {
    return LoosePlan(table, "datagrams are missing, or the fields ring and column");
  }
  return PlacedPlan(table, name, ScanShape{received.header.rows, received.header.columns});
}

void ForgetRanges(RecordedFrame& recorded) {
  std::ranges::fill(recorded.frame.range_m, std::numeric_limits<float>::quiet_NaN());
  recorded.fields.erase("range_m");
}

}  // namespace

RecordedFrame MakeLiveFrame(const ReceivedFrame& received, const std::string& name) {
  const StreamHeader& header = received.header;
  const PointTable table = PointTableOf(received);
  RecordedFrame recorded;
  recorded.name = name;
  for (const char* axis : {"x", "y", "z"}) (void)NeedFieldOf(table, axis, name);
  FillFrame(table, PlanOfStream(received, table, name), recorded);
  Frame& frame = recorded.frame;
  frame.index = header.frame;
  frame.stamp_ns = header.stamp_ns;
  frame.duration_ns = header.duration_ns;
  frame.world_from_sensor = header.world_from_sensor;
  frame.world_from_sensor_end = header.world_from_sensor_end;
  recorded.has_pose = header.axes == StreamAxes::kSensor;
  if (header.is_left_handed) {
    for (float& y : frame.y) y = -y;
  }
  if (!recorded.has_pose && header.Find("range_m") == nullptr) ForgetRanges(recorded);
  return recorded;
}

}  // namespace railcast
