#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "railcast/lidar.h"
#include "railcast/scenario.h"
#include "railcast/transform.h"
#include "railcast/world_spec.h"

namespace railcast {

/// Where the vehicle was at a time.
struct VehiclePose {
  std::int64_t time_ns{};
  Transform world_from_vehicle = Transform::Identity();
};

/// The way that the vehicle took while its sensor recorded. Times count from the first frame.
struct RecordedWay {
  std::int64_t first_stamp_ns{};
  std::vector<std::int64_t> frame_times_ns;  ///< When each frame begins; rising.
  std::vector<Transform> at_frames;          ///< world_from_vehicle when each frame begins.
  /// By time, also between the beginnings of frames where it is known there. At least one.
  std::vector<VehiclePose> poses;
  /// Whether the points of a frame are in the axes of its beginning. The pose then stays what it
  /// was until the next frame begins.
  bool is_held = false;
  /// The greatest number that an object of the recording has; 0 = none is known.
  std::uint32_t last_instance{};

  /// The pose at a time. Between two known ones the position changes linearly and the rotation at a
  /// constant rate; before the first and after the last the motion beside them goes on.
  [[nodiscard]] Transform WorldFromVehicle(std::int64_t time_ns) const;
};

/// Reads the way from a recording, or estimates it.
/// @param world Says where poses come from. @param lidar Says where on the vehicle the sensor is,
///   and how far apart frames without stamps are.
/// @param remarks Receives what the user should know of it.
/// @throws InputError "recording: frame 12: rule (got value)" where there are no poses, where they
///   jump, and where times run backwards.
[[nodiscard]] RecordedWay ReadRecordedWay(const std::filesystem::path& recording,
                                          const RecordingWorldSpec& world,
                                          const LidarSpec& lidar,
                                          std::vector<std::string>& remarks);

}  // namespace railcast
