#pragma once

#include <vtkCamera.h>

#include <array>
#include <optional>
#include <string>
#include <string_view>

#include "viewer/scene/scene.h"

namespace railcast {

/// From where the camera looks, in the axes of a scene, metres.
struct CameraPlace {
  std::array<double, 3> eye_m{};
  std::array<double, 3> target_m{};
  std::array<double, 3> up{0.0, 0.0, 1.0};
};

/// "driver" from the sensor, "chase" from above and behind it, both forward; "side" from the right;
/// "top" from above, forward up.
inline constexpr std::array<std::string_view, 4> kCameraNames = {"driver", "top", "side", "chase"};

/// @param name One of kCameraNames.
/// @param origin_m The sensor's place: see OriginOf.
[[nodiscard]] CameraPlace PresetCamera(std::string_view name,
                                       const std::array<double, 3>& origin_m);

/// Where a cloud's sensor is: its origin. A cloud that does not surround it, one in world
/// coordinates say, is looked at as if its sensor were at its middle.
[[nodiscard]] std::array<double, 3> OriginOf(const PlacedCloud& cloud);

void PlaceCamera(const CameraPlace& place, vtkCamera& camera);
[[nodiscard]] CameraPlace PlaceOf(vtkCamera& camera);

/// As --eye and --target take it: "--eye -20,0,12 --target 35,0,-2".
[[nodiscard]] std::string CameraOptions(const CameraPlace& place);

}  // namespace railcast
