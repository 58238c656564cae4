#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "railcast/effects.h"
#include "railcast/frame.h"
#include "railcast/lidar.h"
#include "railcast/transform.h"

namespace railcast::osi {

/// A lidar as each of its messages describes it.
struct LidarOfView {
  std::uint64_t sensor_id{};    ///< Id of OSI's virtual sensor.
  std::uint64_t detector_id{};  ///< Id of its physical sensor.
  /// From the sensor to OSI's vehicle frame, which has its origin in the middle of the rear axle.
  Transform rear_from_sensor = Transform::Identity();
  const ScanPattern* pattern{};
  std::vector<std::uint32_t> firings;  ///< FiringsByRay() of it.
  int wavelength_nm = 905;
  std::uint32_t max_interactions = 1;  ///< Surfaces that a beam may meet.
  double power_at_threshold_ratio{};   ///< Received to emitted power where power_ratio is 1.
};

/// The firings of a frame in the order of OSI's rays: rows from the top, each from left to right,
/// by the azimuth of its beams from pi to -pi.
[[nodiscard]] std::vector<std::uint32_t> FiringsByRay(const ScanPattern& pattern);

/// Something with a box, in the world frame, at a frame's stamp.
struct ObjectOfView {
  std::uint64_t id{};
  std::string name;
  std::string type;   ///< As scenarios name it: "car".
  std::string label;  ///< "road_vehicle"
  bool moves = false;
  Vector3 size_m = Vector3::Zero();
  Transform world_from_box = Transform::Identity();
  Vector3 velocity_mps = Vector3::Zero();
  std::optional<Vector3> acceleration_mps2{};
  /// From the box's centre to the rear and to the front axle, in the box's axes, where they count.
  std::optional<Vector3> rear_m{};
  std::optional<Vector3> front_m{};
};

/// A frame and the truth that belongs to it.
struct FrameOfView {
  const Frame& frame;
  std::span<const ObjectOfView> objects;  ///< The first is the vehicle that carries the sensor.
  const WeatherSpec& weather;
};

// The following are there, too, in a program that was built without protobuf. Then they throw
// InputError "needs a railcast that was built with protobuf, ... (got one without)".

/// The frame as a serialized message osi3.SensorView of OSI 3.8.0 (docs/osi.md), with a ray for
/// each of the frame's slots: those of a firing follow each other. Equal arguments give equal
/// bytes.
/// @throws InputError "rule (got value)" if it became larger than a message can be.
[[nodiscard]] std::string SensorViewOf(const LidarOfView& lidar, const FrameOfView& view);

/// The serialized FileDescriptorSet that defines the message.
[[nodiscard]] std::string SensorViewDescriptors();

/// "3.21.12"
[[nodiscard]] std::string ProtobufVersion();

}  // namespace railcast::osi
