#include "generator/object_record.h"

#include <nlohmann/json.hpp>
#include <unordered_map>

#include "core/base/error.h"
#include "generator/pose_record.h"

namespace railcast {
namespace {

using Json = nlohmann::ordered_json;

struct Seen {
  std::uint32_t points{};
  std::uint32_t firings{};
};

// By instance. A firing counts once for an object, however many of its echoes come from it.
std::unordered_map<std::uint32_t, Seen> CountInstances(const Frame& frame) {
  std::unordered_map<std::uint32_t, Seen> seen;
  for (std::size_t first = 0; first < frame.num_slots(); first += frame.returns) {
    for (std::size_t slot = first; slot < first + frame.returns; ++slot) {
      const std::uint32_t instance = frame.instance[slot];
      if (instance == 0) continue;
      bool is_new = true;
      for (std::size_t earlier = first; earlier < slot; ++earlier) {
        is_new = is_new && frame.instance[earlier] != instance;
      }
      Seen& entry = seen[instance];
      entry.firings += is_new ? 1U : 0U;
      entry.points += HasPoint(frame.outcome[slot]) ? 1U : 0U;
    }
  }
  return seen;
}

Json Box(const Transform& to_from_box, const Vector3& size_m) {
  const Vector3 centre_m = to_from_box.translation();
  const Eigen::Quaterniond turn = CanonicalRotation(to_from_box);
  return {{"center_m", {centre_m.x(), centre_m.y(), centre_m.z()}},
          {"size_m", {size_m.x(), size_m.y(), size_m.z()}},
          {"quaternion_xyzw", {turn.x(), turn.y(), turn.z(), turn.w()}}};
}

}  // namespace

std::vector<ObjectInFrame> DescribeObjects(const World& world,
                                           const LabelTable& labels,
                                           const Frame& frame,
                                           const std::vector<std::uint32_t>& firings_alone) {
  const std::vector<SceneObject>& all = world.objects();
  Check(firings_alone.size() == all.size(), "one count for each object");
  const auto seen = CountInstances(frame);
  std::vector<ObjectInFrame> described;
  for (std::size_t i = 0; i < all.size(); ++i) {
    const SceneObject& object = all[i];
    if (object.is_ego) continue;
    const Label* label = labels.Find(object.label);
    Check(label != nullptr, "an object's label is in the label table");
    const Eigen::AlignedBox3d bounds_m = object.model->Bounds();
    ObjectInFrame entry{object.name, object.type, label->name, object.instance};
    entry.size_m = bounds_m.sizes();
    entry.world_from_box =
        world.WorldFromObject(i, frame.stamp_ns) * Eigen::Translation3d(bounds_m.center());
    entry.firings_alone = firings_alone[i];
    if (const auto found = seen.find(object.instance); found != seen.end()) {
      entry.points = found->second.points;
      entry.firings_visible = found->second.firings;
    }
    described.push_back(std::move(entry));
  }
  return described;
}

std::string ObjectsLine(const Frame& frame, const std::vector<ObjectInFrame>& objects) {
  const Transform sensor_from_world = frame.world_from_sensor.inverse();
  Json list = Json::array();
  for (const ObjectInFrame& object : objects) {
    Json occlusion;  // null
    if (object.firings_alone > 0) {
      occlusion = 1.0 - static_cast<double>(object.firings_visible) /
                            static_cast<double>(object.firings_alone);
    }
    list.push_back({{"name", object.name},
                    {"type", object.type},
                    {"label", object.label},
                    {"instance", object.instance},
                    {"world", Box(object.world_from_box, object.size_m)},
                    {"sensor", Box(sensor_from_world * object.world_from_box, object.size_m)},
                    {"points", object.points},
                    {"firings_visible", object.firings_visible},
                    {"firings_alone", object.firings_alone},
                    {"occlusion", occlusion}});
  }
  const Json line = {{"frame", frame.index}, {"stamp_ns", frame.stamp_ns}, {"objects", list}};
  return line.dump() + "\n";
}

}  // namespace railcast
