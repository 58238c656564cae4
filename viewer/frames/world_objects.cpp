#include "viewer/frames/world_objects.h"

#include "core/base/units.h"

namespace railcast {

std::vector<RecordedObject> ObjectsAt(const World& world,
                                      const LabelTable& labels,
                                      const Frame& frame) {
  const Transform sensor_from_world = frame.world_from_sensor.inverse();
  const std::int64_t end_ns = frame.stamp_ns + frame.duration_ns;
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
    const Transform world_from_object = world.WorldFromObject(i, frame.stamp_ns);
    recorded.sensor_from_box =
        sensor_from_world * world_from_object * Eigen::Translation3d(bounds_m.center());
    if (object.moves && frame.duration_ns > 0) {
      const Vector3 way_m = world.WorldFromObject(i, end_ns) * bounds_m.center() -
                            world_from_object * bounds_m.center();
      recorded.velocity_world_mps = way_m / SecondsFromNs(frame.duration_ns);
    }
    objects.push_back(std::move(recorded));
  }
  return objects;
}

}  // namespace railcast
