#include "viewer/frames/world_objects.h"

namespace railcast {

std::vector<RecordedObject> ObjectsAt(const World& world,
                                      const LabelTable& labels,
                                      const Frame& frame) {
  const Transform sensor_from_world = frame.world_from_sensor.inverse();
  std::vector<RecordedObject> objects;
  for (std::size_t i = 0; i < world.objects().size(); ++i) {
    const SceneObject& object = world.objects()[i];
    if (object.is_ego) continue;
    const Eigen::AlignedBox3d bounds_m = object.model->Bounds();
    const Label* const label = labels.Find(object.label);
    RecordedObject recorded;
    recorded.name = object.name;
    recorded.type = object.type;
    recorded.label = label == nullptr ? std::string() : label->name;
    recorded.instance = object.instance;
    recorded.size_m = bounds_m.sizes();
    recorded.sensor_from_box = sensor_from_world * world.WorldFromObject(i, frame.stamp_ns) *
                               Eigen::Translation3d(bounds_m.center());
    objects.push_back(std::move(recorded));
  }
  return objects;
}

}  // namespace railcast
