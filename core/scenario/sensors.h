#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "railcast/scenario.h"

namespace railcast {

/// A sensor and its place in the scenario.
struct SensorPlace {
  const LidarSpec& lidar;
  std::string pointer;  ///< "/lidar" or "/lidars/1".
};

/// All sensors of a scenario, in their order. The result refers to `spec`.
[[nodiscard]] std::vector<SensorPlace> SensorsOf(const ScenarioSpec& spec);

/// The first fault in the assignment of receivers to sensors; empty if there is none.
/// @param sensors The names of all sensors; empty if the scenario has only one, under `lidar`.
[[nodiscard]] std::string InterfacesFault(const InterfacesSpec& interfaces,
                                          const std::vector<std::string>& sensors);

/// The port that the sensors of Velodyne and Hesai send frames to and from.
inline constexpr std::uint16_t kVelodyneDataPort = 2368;
/// The port of each receiver to which sensors of Velodyne's protocols send position packets,
/// whatever the port of their frames.
inline constexpr std::uint16_t kVelodynePositionPort = 8308;
/// The ports that Ouster's sensors send frames and their motion to.
inline constexpr std::uint16_t kOusterLidarPort = 7502;
inline constexpr std::uint16_t kOusterImuPort = 7503;

/// The port of position packets; absent if sensors of this protocol send none.
[[nodiscard]] std::optional<std::uint16_t> PositionPort(Protocol protocol);

/// Whether each receiver is named once.
[[nodiscard]] bool AreDifferent(const std::vector<std::string>& receivers);
/// The first receiver of frames that gets position packets, too; a rule that it breaks. Empty if
/// there is none.
[[nodiscard]] std::string PositionsFault(const InterfacesSpec& interfaces);
/// The first receiver of images that gets a sensor's datagrams, too; a rule that it breaks. Empty
/// if there is none.
[[nodiscard]] std::string ImagesFault(const CameraSpec& camera, const InterfacesSpec& interfaces);

/// How many frames of a sensor follow each other from one image to the next; absent if the rates do
/// not allow a whole number of at most 1,000,000.
[[nodiscard]] std::optional<std::uint32_t> FramesFromImageToImage(const CameraSpec& camera,
                                                                  double scan_rate_hz);
/// Whether that number exists for the camera and each of the scenario's sensors.
/// @pre The scenario has a camera.
[[nodiscard]] bool HasFramesForImages(const ScenarioSpec& spec);

/// Whether each motion sensor has at most kMostSamplesInFrame samples in the time from one frame of
/// any of the scenario's sensors to the next.
[[nodiscard]] bool HasFewSamplesInFrame(const MotionSensorsSpec& motion_sensors,
                                        const ScenarioSpec& spec);
inline constexpr double kMostSamplesInFrame = 100'000.0;

}  // namespace railcast
