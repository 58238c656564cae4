#include "core/io/recording/sequence_lines.h"

#include "core/io/cloud/kitti.h"

namespace railcast {

std::vector<RecordedObject> ReadObjectsLine(std::string_view line,
                                            std::uint32_t frame,
                                            const std::string& place) {
  std::vector<RecordedObject> objects;
  for (const ObjectRecord& record : ReadObjectsRecord(line, frame, place).objects) {
    objects.push_back({.name = record.name,
                       .type = record.type,
                       .label = record.label,
                       .instance = record.instance,
                       .size_m = record.sensor.size_m,
                       .sensor_from_box = record.sensor.ToFromBox(),
                       .velocity_world_mps = record.velocity_world_mps,
                       .points = record.points,
                       .points_time_ns = record.points_time_ns,
                       .firings_visible = record.firings_visible,
                       .firings_alone = record.firings_alone,
                       .occlusion = record.occlusion});
  }
  return objects;
}

RecordedObject RecordedOf(const ObjectInFrame& object, const Transform& sensor_from_world) {
  RecordedObject recorded{.name = object.name,
                          .type = object.type,
                          .label = object.label,
                          .instance = object.instance,
                          .size_m = object.size_m,
                          .sensor_from_box = sensor_from_world * object.world_from_box,
                          .velocity_world_mps = object.velocity_world_mps,
                          .points = object.points,
                          .firings_visible = object.view.firings_visible,
                          .firings_alone = object.view.firings_alone,
                          .occlusion = object.view.occlusion()};
  if (object.points > 0) recorded.points_time_ns = object.points_time_ns;
  return recorded;
}

std::string KittiClassOf(const RecordedObject& object,
                         const LabelTable& labels,
                         const LabelTable& kitti) {
  const Label* const label = labels.Find(object.label);
  if (label == nullptr) return object.label;
  const std::uint16_t standing = label->semantic_kitti;
  const Label* const kitti_class =
      kitti.Find(IsMoving(object.velocity_world_mps) ? MovingSemanticKitti(standing) : standing);
  return kitti_class == nullptr ? object.label : kitti_class->name;
}

}  // namespace railcast
