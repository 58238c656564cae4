#include "viewer/frames/frames.h"

#include <utility>

#include "core/base/error.h"
#include "core/base/text.h"
#include "core/base/units.h"
#include "core/io/cloud/kitti.h"
#include "core/io/run/scenario_identity.h"
#include "railcast/rail_world.h"
#include "railcast/scenario.h"

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

void Frames::UseScenario(const ScenarioSpec& scenario) {
  if (info_.scenario) {
    if (IdentityOf(*info_.scenario) == IdentityOf(scenario)) return;
    throw InputError(ShownPath(info_.source) +
                     ": has a scenario of its own: --scenario must be the same or be left out");
  }
  world_ = MakeWorld(scenario);
  info_.scenario = scenario;
  info_.labels = LabelTable(scenario.labels);
  if (info_.has_kitti_labels) info_.labels = SemanticKittiLabels(info_.labels);
  info_.materials.clear();
  const MaterialLibrary library(scenario.materials);
  for (const Material& material : library.materials()) info_.materials.push_back(material.name);
}

std::shared_ptr<const ShownFrame> Frames::Shown(RecordedFrame recorded) const {
  if (world_ && recorded.has_pose && recorded.objects.empty()) {
    recorded.objects = ObjectsAt(*world_, LabelTable(info_.scenario->labels), recorded.frame);
  }
  return std::make_shared<const ShownFrame>(MakeShownFrame(std::move(recorded)));
}

}  // namespace railcast
