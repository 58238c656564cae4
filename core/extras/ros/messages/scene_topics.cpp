#include "core/extras/ros/messages/scene_topics.h"

#include "core/base/text.h"
#include "core/base/units.h"
#include "core/extras/ros/messages/point_layout.h"

namespace railcast::ros {
namespace {

constexpr std::string_view kMap = "map";

Color ColorOf(const LabelTable& labels, const std::string& name, double alpha) {
  const Label* const label = labels.Find(name);
  if (label == nullptr) return {1.0, 1.0, 1.0, alpha};
  constexpr double kWhite = 255.0;
  return {label->rgb[0] / kWhite, label->rgb[1] / kWhite, label->rgb[2] / kWhite, alpha};
}

std::vector<KeyValuePair> BoxMetadata(const SceneBox& box) {
  std::vector<KeyValuePair> pairs = {
      {"label", box.label},
      {"instance", NumberText(box.instance)},
      {"points", NumberText(box.points)},
      {"speed_mps", NumberText(box.velocity_world_mps.norm())},
  };
  if (box.occlusion) pairs.push_back({"occlusion", NumberText(*box.occlusion)});
  return pairs;
}

TextPrimitive TextAbove(const SceneBox& box, const Transform& map_from_box, const Color& color) {
  constexpr double kFontSize_px = 14.0;
  constexpr double kGap_m = 0.3;
  TextPrimitive text;
  const Vector3 top_m(0.0, 0.0, box.size_m.z() / 2.0 + kGap_m);
  text.pose.position = PointOf(map_from_box * top_m);
  text.billboard = true;
  text.font_size = kFontSize_px;
  text.scale_invariant = true;
  text.color = color;
  text.text = box.name == box.label ? box.label : box.label + " " + box.name;
  return text;
}

SceneEntity EntityOf(const SceneBox& box,
                     const LabelTable& labels,
                     const Transform& map_from_world) {
  constexpr double kBoxAlpha = 0.4;
  const Transform map_from_box = map_from_world * box.world_from_box;
  SceneEntity entity;
  entity.frame_id = kMap;
  entity.id = box.name;
  entity.metadata = BoxMetadata(box);
  entity.cubes = {
      {PoseOf(map_from_box), VectorOf(box.size_m), ColorOf(labels, box.label, kBoxAlpha)}};
  entity.texts = {TextAbove(box, map_from_box, ColorOf(labels, box.label, 1.0))};
  return entity;
}

}  // namespace

RosVector3 VectorOf(const Vector3& vector) {
  return {vector.x(), vector.y(), vector.z()};
}

Point PointOf(const Vector3& position_m) {
  return {position_m.x(), position_m.y(), position_m.z()};
}

Quaternion QuaternionOf(const Transform& transform) {
  Eigen::Quaterniond turn(transform.linear());
  if (turn.w() < 0.0) turn.coeffs() = -turn.coeffs();
  return {turn.x(), turn.y(), turn.z(), turn.w()};
}

Pose PoseOf(const Transform& transform) {
  return {PointOf(transform.translation()), QuaternionOf(transform)};
}

SceneUpdate BoxesUpdate(std::span<const SceneBox> boxes,
                        const LabelTable& labels,
                        const Transform& map_from_world,
                        std::int64_t time_ns,
                        std::int64_t lifetime_ns) {
  SceneUpdate update;
  for (const SceneBox& box : boxes) {
    SceneEntity& entity = update.entities.emplace_back(EntityOf(box, labels, map_from_world));
    entity.timestamp = TimeOf(time_ns);
    const Time lifetime = TimeOf(lifetime_ns);
    entity.lifetime = {lifetime.sec, lifetime.nanosec};
  }
  return update;
}

SceneUpdate RailsUpdate(const std::vector<std::vector<Vector3>>& rails_m,
                        const Transform& map_from_world,
                        std::int64_t time_ns) {
  constexpr double kHeadWidth_m = 0.07;
  constexpr Color kSteel = {0.6, 0.6, 0.65, 1.0};
  SceneUpdate update;
  SceneEntity& entity = update.entities.emplace_back();
  entity.timestamp = TimeOf(time_ns);
  entity.frame_id = kMap;
  entity.id = "track";
  for (const std::vector<Vector3>& rail_m : rails_m) {
    LinePrimitive& line = entity.lines.emplace_back();
    line.type = LinePrimitive::kLineStrip;
    line.thickness = kHeadWidth_m;
    line.color = kSteel;
    for (const Vector3& point_m : rail_m) line.points.push_back(PointOf(map_from_world * point_m));
  }
  return update;
}

}  // namespace railcast::ros
