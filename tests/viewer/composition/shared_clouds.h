#pragma once

#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "tests/viewer/pick/shown_cloud.h"
#include "viewer/composition/composer.h"

namespace railcast {

inline std::shared_ptr<const ShownFrame> Shared(RecordedFrame recorded) {
  return std::make_shared<const ShownFrame>(MakeShownFrame(std::move(recorded)));
}

inline std::shared_ptr<const ShownFrame> SharedCloud(const std::vector<Vector3>& points_m) {
  return Shared(RecordedCloud("a.pcd", points_m));
}

/// A cloud of three points with the labels 1, 12 and 0.
inline std::shared_ptr<const ShownFrame> LabelledCloud() {
  RecordedFrame recorded = RecordedCloud("a.pcd", {{1, 2, 3}, {4, 5, 6}, {7, 8, 9}});
  recorded.fields.emplace("label");
  recorded.frame.label = {1, 12, 0};
  return Shared(std::move(recorded));
}

/// A cloud of points given in the world, seen from `world_from_sensor`.
inline std::shared_ptr<const ShownFrame> Posed(const std::vector<Vector3>& points_world_m,
                                               const Transform& world_from_sensor) {
  std::vector<Vector3> points_m;
  for (const Vector3& point_m : points_world_m) {
    points_m.push_back(world_from_sensor.inverse() * point_m);
  }
  RecordedFrame recorded = RecordedCloud("a.pcd", points_m);
  recorded.has_pose = true;
  recorded.frame.world_from_sensor = world_from_sensor;
  return Shared(std::move(recorded));
}

inline Choices By(const std::string& field) {
  return {.color_by = field};
}

}  // namespace railcast
