#pragma once

#include <gtest/gtest.h>

#include <limits>
#include <string>
#include <vector>

#include <osi_sensor_view.pb.h>
#include "generator/extras/osi/sensor_view.h"

namespace railcast::osi {

/// A raster of 4 columns and 3 rows, 10 degrees apart.
inline const ScanPattern& ExamplePattern() {
  static const ScanPattern pattern =
      BuildScanPattern({.rate_hz = 10.0, .pattern = RasterSpec{40.0, 30.0, 10.0}});
  return pattern;
}

inline LidarOfView ExampleLidar() {
  LidarOfView lidar;
  lidar.sensor_id = 0;
  lidar.detector_id = 1;
  lidar.rear_from_sensor =
      MakeTransform(RotationFromYawPitchRoll(0.1, 0.2, 0.3), Vector3(12.4, 0.5, 2.5));
  lidar.pattern = &ExamplePattern();
  lidar.firings = FiringsByRay(ExamplePattern());
  lidar.power_at_threshold_ratio = 1e-10;
  return lidar;
}

/// A frame of the pattern whose beams met nothing.
inline Frame EmptyFrame(std::uint32_t returns = 1) {
  Frame frame;
  frame.Resize(ExamplePattern().rows, ExamplePattern().columns, returns);
  frame.stamp_ns = 2'500'000'001;
  for (std::size_t i = 0; i < frame.num_slots(); ++i) {
    frame.outcome[i] = Outcome::kNoSurface;
    frame.range_m[i] = std::numeric_limits<float>::quiet_NaN();
    frame.power_ratio[i] = std::numeric_limits<float>::quiet_NaN();
    frame.instance[i] = 0;
  }
  return frame;
}

/// Gives a slot a point.
inline void PutPoint(std::size_t slot, float range_m, std::uint32_t instance, Frame& frame) {
  frame.outcome[slot] = Outcome::kReturned;
  frame.range_m[slot] = range_m;
  frame.power_ratio[slot] = 2.0F;
  frame.instance[slot] = instance;
}

inline ObjectOfView ExampleObject(std::uint64_t id,
                                  const std::string& label,
                                  const std::string& type = "") {
  return {.id = id,
          .name = label + std::to_string(id),
          .type = type,
          .label = label,
          .size_m = Vector3(4.0, 2.0, 1.5),
          .world_from_box =
              MakeTransform(RotationFromYawPitchRoll(-2.0, 0.3, -0.4), Vector3(5.3e6, 6e5, 412.25)),
          .velocity_mps = Vector3(1.0, 2.0, 3.0)};
}

/// What a reader finds in the message of a frame.
inline osi3::SensorView ReadView(const LidarOfView& lidar,
                                 const Frame& frame,
                                 const std::vector<ObjectOfView>& objects = {ExampleObject(7,
                                                                                           "ego")},
                                 const WeatherSpec& weather = {}) {
  osi3::SensorView view;
  EXPECT_TRUE(view.ParseFromString(SensorViewOf(lidar, {frame, objects, weather})));
  return view;
}

inline Vector3 VectorOf(const osi3::Vector3d& message) {
  return {message.x(), message.y(), message.z()};
}

inline Eigen::Matrix3d RotationOf(const osi3::Orientation3d& message) {
  return RotationFromYawPitchRoll(message.yaw(), message.pitch(), message.roll());
}

}  // namespace railcast::osi
