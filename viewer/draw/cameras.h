#pragma once

#include <vtkCamera.h>

#include <array>
#include <span>
#include <string>
#include <string_view>

namespace railcast {

/// Where the camera is and where it looks, in the axes of a composition, in metres.
struct CameraPlace {
  std::array<double, 3> eye_m{};
  std::array<double, 3> target_m{};
  std::array<double, 3> up{0.0, 0.0, 1.0};
};

/// Returns a camera with z up on the screen, or x up where it looks straight up or down.
[[nodiscard]] CameraPlace UprightCamera(const std::array<double, 3>& eye_m,
                                        const std::array<double, 3>& target_m);

/// "driver" looks forward from the sensor, "chase" forward from above and behind it; "side" looks
/// from the right; "top" from above with forward up, ahead of the sensor or, if points are all
/// around it, on it; "all" looks like "chase" from as far as it takes to see the cloud.
inline constexpr std::array<std::string_view, 5> kCameraNames = {"driver", "top", "side", "chase",
                                                                 "all"};

/// Returns the camera of a preset. All but "all" are relative to the sensor, which is the cloud's
/// origin. For a cloud that does not surround its origin, such as one in world coordinates, the
/// middle of the cloud is taken instead.
/// @param name One of kCameraNames.
/// @param positions_m x, y, z of each point in turn; may be empty.
/// @param is_origin_on_rails Whether "driver" must look from above the origin, not from beside it.
[[nodiscard]] CameraPlace PresetCamera(std::string_view name,
                                       std::span<const float> positions_m,
                                       bool is_origin_on_rails);

void PlaceCamera(const CameraPlace& place, vtkCamera& camera);
[[nodiscard]] CameraPlace PlaceOf(vtkCamera& camera);

/// Returns the camera as options: "--eye -20,0,12 --target 35,0,-2".
[[nodiscard]] std::string CameraOptions(const CameraPlace& place);

}  // namespace railcast
