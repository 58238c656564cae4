#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "railcast/io/recording.h"
#include "tests/analysis/recorded_frames.h"

namespace railcast {

/// A frame with these points in the sensor's axes, of a sensor 2 m above the axis of
/// StraightTrack(), which looks along it and goes at 20 m/s. Slots and places in the file agree.
[[nodiscard]] inline RecordedFrame FrameOf(const std::vector<Vector3>& points,
                                           std::uint32_t index = 0,
                                           double sensor_x_m = 500.0) {
  Frame frame;
  frame.index = index;
  frame.duration_ns = 100'000'000;
  frame.world_from_sensor.translation() = Vector3(sensor_x_m, 0.0, 2.0);
  frame.world_from_sensor_end.translation() = Vector3(sensor_x_m + 2.0, 0.0, 2.0);
  frame.Resize(1, static_cast<std::uint32_t>(points.size()), 1);
  for (std::size_t i = 0; i < points.size(); ++i) {
    frame.x[i] = static_cast<float>(points[i].x());
    frame.y[i] = static_cast<float>(points[i].y());
    frame.z[i] = static_cast<float>(points[i].z());
    frame.time_ns[i] = 0;
    frame.label[i] = 0;
  }
  RecordedFrame recorded = Record(std::move(frame));
  recorded.name = "frame.pcd";
  for (std::uint32_t i = 0; i < points.size(); ++i) recorded.slot_of_entry.push_back(i);
  return recorded;
}

/// Adds an object to a frame of FrameOf(), with its foot on the rails.
/// @param ahead_m,left_m Of its middle, from the sensor.
inline void AddObject(const std::string& name,
                      double ahead_m,
                      double left_m,
                      const Vector3& size_m,
                      RecordedFrame& recorded) {
  RecordedObject object{.name = name, .type = "box", .label = "object"};
  object.size_m = size_m;
  object.sensor_from_box.translation() = Vector3(ahead_m, left_m, 0.5 * size_m.z() - 2.0);
  recorded.objects.push_back(object);
}

}  // namespace railcast
