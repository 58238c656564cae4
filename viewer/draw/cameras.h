#pragma once

#include <vtkCamera.h>

#include <array>
#include <span>
#include <string>
#include <string_view>

namespace railcast {

/// From where the camera looks, in the axes of a scene, metres.
struct CameraPlace {
  std::array<double, 3> eye_m{};
  std::array<double, 3> target_m{};
  std::array<double, 3> up{0.0, 0.0, 1.0};
};

/// With z up on the screen, or, straight from above or below, x.
[[nodiscard]] CameraPlace UprightCamera(const std::array<double, 3>& eye_m,
                                        const std::array<double, 3>& target_m);

/// "driver" from the sensor, "chase" from above and behind it, both forward; "side" from the right;
/// "top" from above, forward up; "all" like "chase", from as far as the cloud needs.
inline constexpr std::array<std::string_view, 5> kCameraNames = {"driver", "top", "side", "chase",
                                                                 "all"};

/// All but "all" are relative to the sensor, the cloud's origin. A cloud that does not surround it,
/// one in world coordinates say, is looked at as if its sensor were at its middle.
/// @param name One of kCameraNames.
/// @param positions_m x, y, z of each point in turn; may be empty.
[[nodiscard]] CameraPlace PresetCamera(std::string_view name, std::span<const float> positions_m);

void PlaceCamera(const CameraPlace& place, vtkCamera& camera);
[[nodiscard]] CameraPlace PlaceOf(vtkCamera& camera);

/// As --eye and --target take it: "--eye -20,0,12 --target 35,0,-2".
[[nodiscard]] std::string CameraOptions(const CameraPlace& place);

}  // namespace railcast
