#include "core/io/recording/live_frame.h"

#include <algorithm>
#include <limits>

#include "core/io/recording/cloud_fields.h"
#include "core/io/recording/slot_plans.h"
#include "core/io/stream/stream_clouds.h"

namespace railcast {
namespace {

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

SlotPlan PlanOfStream(const ReceivedFrame& received, const Cloud& cloud, const std::string& name) {
  if (!IsGrid(received)) {
    return LoosePlan(cloud, "datagrams are missing, or the fields ring and column");
  }
  return PlacedPlan(cloud, name, ScanShape{received.header.rows, received.header.columns});
}

void ForgetRanges(RecordedFrame& recorded) {
  std::ranges::fill(recorded.frame.range_m, std::numeric_limits<float>::quiet_NaN());
  recorded.fields.erase("range_m");
}

}  // namespace

RecordedFrame MakeLiveFrame(const ReceivedFrame& received, const std::string& name) {
  const StreamHeader& header = received.header;
  const Cloud cloud = MakeCloud(received);
  RecordedFrame recorded;
  recorded.name = name;
  for (const char* axis : {"x", "y", "z"}) (void)NeedFieldOf(cloud, axis, name);
  FillFrame(cloud, PlanOfStream(received, cloud, name), recorded);
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
