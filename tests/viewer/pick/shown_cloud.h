#pragma once

#include <memory>
#include <string>
#include <vector>

#include "viewer/frames/shown_frame.h"

namespace railcast {

/// A frame of one row of points, without motion.
/// @param points_m In the sensor's axes.
inline RecordedFrame RecordedCloud(const std::string& name, const std::vector<Vector3>& points_m) {
  RecordedFrame recorded;
  recorded.name = name;
  recorded.fields = {"x", "y", "z", "range_m"};
  Frame& frame = recorded.frame;
  frame.Resize(1, static_cast<std::uint32_t>(points_m.size()), 1);
  for (std::size_t i = 0; i < points_m.size(); ++i) {
    const Eigen::Vector3f point_m = points_m[i].cast<float>();
    frame.x[i] = point_m.x();
    frame.y[i] = point_m.y();
    frame.z[i] = point_m.z();
    frame.range_m[i] = point_m.norm();
  }
  return recorded;
}

inline ShownFrame Show(RecordedFrame recorded) {
  ShownFrame shown;
  const Frame& frame = recorded.frame;
  for (std::uint32_t slot = 0; slot < frame.num_slots(); ++slot) {
    shown.positions_m.insert(shown.positions_m.end(),
                             {frame.x[slot], frame.y[slot], frame.z[slot]});
    shown.slots.push_back(slot);
  }
  shown.recorded = std::make_shared<const RecordedFrame>(std::move(recorded));
  return shown;
}

}  // namespace railcast
