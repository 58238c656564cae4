#include "generator/extras/insert/clouds/inserted_objects.h"

#include <algorithm>
#include <map>
#include <utility>

#include "core/io/record/record_text.h"
#include "core/io/run/object_survey.h"

namespace railcast {
namespace {

/// The points of an instance and the sum of their times.
struct TimedPoints {
  std::int64_t num{};
  std::int64_t time_ns{};
};

/// What instances have lost.
std::map<std::uint32_t, TimedPoints> LostPoints(const RecordedFirings& firings,
                                                const InsertedFrame& inserted) {
  const Frame& before = firings.recorded.frame;
  const Frame& after = inserted.recorded.frame;
  std::map<std::uint32_t, TimedPoints> lost;
  const auto count = [&](const Frame& frame, std::uint32_t slot, int change) {
    TimedPoints& points = lost[frame.instance[slot]];
    points.num += change;
    points.time_ns += change * std::int64_t{frame.time_ns[slot]};
  };
  for (const SlotEdit& edit : inserted.edits) {
    if (edit.had_point) count(before, edit.slot, 1);
    if (edit.has_point && (!edit.is_added || edit.is_merged)) count(after, edit.slot, -1);
  }
  return lost;
}

std::vector<ObjectRecord> RecordsOf(const Frame& frame,
                                    const std::vector<RecordedObject>& recorded) {
  std::vector<ObjectInFrame> objects;
  for (const RecordedObject& object : recorded) {
    ObjectInFrame entry{object.name, object.type, object.label, object.instance};
    entry.size_m = object.size_m;
    entry.world_from_box = frame.world_from_sensor * object.sensor_from_box;
    entry.output_from_box = object.sensor_from_box;
    entry.velocity_world_mps = object.velocity_world_mps;
    entry.points = object.points;
    entry.points_time_ns = object.points_time_ns.value_or(0);
    entry.view.firings_visible = object.firings_visible;
    entry.view.firings_alone = object.firings_alone;
    objects.push_back(std::move(entry));
  }
  std::vector<ObjectRecord> records = RecordOf(frame, objects).objects;
  // What is hidden was counted in rays, of which only the share is known here.
  for (std::size_t i = 0; i < records.size(); ++i) {
    if (recorded[i].occlusion) records[i].occlusion = recorded[i].occlusion;
  }
  return records;
}

// Takes from an object the points that it has lost.
void TakePoints(const TimedPoints& lost, ObjectRecord& object) {
  const std::int64_t points = object.points;
  const std::int64_t left = std::max<std::int64_t>(0, points - lost.num);
  object.points = static_cast<std::uint32_t>(left);
  if (left == 0) object.points_time_ns.reset();
  if (!object.points_time_ns) return;
  const std::int64_t sum_ns = *object.points_time_ns * points - lost.time_ns;
  object.points_time_ns = static_cast<std::uint32_t>(std::max<std::int64_t>(0, sum_ns / left));
}

}  // namespace

std::string InsertedObjectsLine(const RecordedFirings& firings,
                                const InsertedFrame& inserted,
                                std::uint32_t number,
                                std::int64_t stamp_ns) {
  const RecordedFrame& recorded = inserted.recorded;
  return ObjectsWith({number, stamp_ns, RecordsOf(recorded.frame, recorded.objects)}, firings,
                     inserted);
}

std::string ObjectsWith(ObjectsRecord record,
                        const RecordedFirings& firings,
                        const InsertedFrame& inserted) {
  const auto lost = LostPoints(firings, inserted);
  for (ObjectRecord& object : record.objects) {
    const auto found = lost.find(object.instance);
    if (found != lost.end() && found->second.num != 0) TakePoints(found->second, object);
  }
  for (ObjectRecord& added : RecordsOf(inserted.recorded.frame, inserted.objects)) {
    record.objects.push_back(std::move(added));
  }
  return RecordText(record) + "\n";
}

}  // namespace railcast
