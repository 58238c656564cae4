#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "core/extras/ros/messages/frame_topics.h"
#include "core/extras/ros/messages/geometry_messages.h"
#include "core/extras/ros/messages/scene_messages.h"
#include "railcast/frame.h"
#include "railcast/transform.h"

namespace railcast::ros {

[[nodiscard]] RosVector3 VectorOf(const Vector3& vector);
[[nodiscard]] Point PointOf(const Vector3& position_m);
/// The one of a rotation's two quaternions that has w >= 0.
[[nodiscard]] Quaternion QuaternionOf(const Transform& transform);
[[nodiscard]] Pose PoseOf(const Transform& transform);

/// The boxes of a frame's objects in the frame of reference `map`, each with its label as text, in
/// the label's colour. Metadata say what objects.jsonl says.
/// @param lifetime_ns How long they are shown.
[[nodiscard]] SceneUpdate BoxesUpdate(std::span<const SceneBox> boxes,
                                      const LabelTable& labels,
                                      const Transform& map_from_world,
                                      std::int64_t time_ns,
                                      std::int64_t lifetime_ns);

/// Lines in the world frame as one entity in the frame of reference `map`, shown for ever.
[[nodiscard]] SceneUpdate RailsUpdate(const std::vector<std::vector<Vector3>>& rails_m,
                                      const Transform& map_from_world,
                                      std::int64_t time_ns);

}  // namespace railcast::ros
