#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "railcast/lidar.h"
#include "railcast/material.h"
#include "railcast/simulator.h"
#include "railcast/transform.h"

namespace railcast {

/// Lens distortion by the Brown-Conrady model, with OpenCV's names and signs. A point at (x, y, 1)
/// in optical axes, r^2 = x^2 + y^2, is seen at
///   x' = x (1 + k1 r^2 + k2 r^4 + k3 r^6) + 2 p1 x y + p2 (r^2 + 2 x^2)
///   y' = y (1 + k1 r^2 + k2 r^4 + k3 r^6) + p1 (r^2 + 2 y^2) + 2 p2 x y
struct DistortionSpec {
  double k1{}, k2{};
  double p1{}, p2{};
  double k3{};

  bool operator==(const DistortionSpec&) const = default;
};

/// Section `camera` (the published Camera.json): a pinhole camera beside the sensor.
struct CameraSpec {
  std::uint32_t width_px{};
  std::uint32_t height_px{};
  /// Angle between the left and the right edge of the image, without distortion.
  double horizontal_fov_deg{};
  std::string name = "camera";
  /// Images per second; absent = one with each frame of the sensor.
  std::optional<double> rate_hz{};
  std::optional<MountSpec> mount{};  ///< Absent = that of the sensor.
  std::optional<DistortionSpec> distortion{};
  std::vector<std::string> udp{};  ///< host:port of each receiver of live images.

  bool operator==(const CameraSpec&) const = default;
};

/// The largest number of pixels of an image, the same as that of firings of a frame.
inline constexpr std::uint64_t kMostPixels = std::uint64_t{1} << 24U;

/// A camera's matrix: a point at (x', y', 1) in optical axes, after distortion, is at the pixel
/// coordinates u = focal_px x' + cx_px, v = focal_px y' + cy_px. Whole numbers are the centres of
/// pixels, as in OpenCV: (0, 0) is the centre of the upper left one.
struct Intrinsics {
  double focal_px{};
  double cx_px{};
  double cy_px{};
};
[[nodiscard]] Intrinsics IntrinsicsOf(const CameraSpec& spec);

/// Whether the name can be that of a folder: 1 to 64 lower-case letters, digits and _.
[[nodiscard]] bool IsCameraName(std::string_view name);

/// Whether the distortion is invertible over the whole image: each pixel has one direction.
[[nodiscard]] bool IsInvertible(const CameraSpec& spec);

/// What a camera sees at one instant. Pixels are stored row by row, from the upper left.
struct CameraImage {
  std::uint32_t width_px{};
  std::uint32_t height_px{};
  std::int64_t stamp_ns{};  ///< Simulation time: the stamp of the frame.
  /// Pose at the stamp, of the optical axes: x right, y down, z forward.
  Transform world_from_camera = Transform::Identity();
  std::vector<std::uint8_t> rgb;  ///< Three bytes a pixel, sRGB.
  /// z in the optical axes of the surface at the pixel's centre, m; NaN where there is none within
  /// the sensor's range_max_m of the camera.
  std::vector<float> depth_m;
  std::vector<std::uint32_t> label;     ///< Id in the label table; 0 = no surface.
  std::vector<std::uint32_t> instance;  ///< As Frame::instance.

  [[nodiscard]] std::size_t num_pixels() const { return std::size_t{width_px} * height_px; }
};

/// Renders images of a simulator's scenes: casts one ray through the centre of each pixel and one
/// from the surface hit there to the sun, and draws wires by their widths in the pixels.
/// docs/camera.md says what the colours model. MakeCamera() makes that of a scenario. Immutable.
///
///     camera.Render(*simulator, frame_index, image);
class Camera {
 public:
  /// @param vehicle_from_camera Pose of the optical axes.
  /// @throws InputError "/distortion: rule" if IsInvertible() does not hold.
  Camera(const CameraSpec& spec,
         const Transform& vehicle_from_camera,
         const MaterialLibrary& materials);

  [[nodiscard]] const CameraSpec& spec() const { return spec_; }
  [[nodiscard]] const Transform& vehicle_from_camera() const { return vehicle_from_camera_; }

  /// Renders the scene of a frame as it is at the frame's stamp, in the simulator's weather and on
  /// its threads. The image depends on the frame alone. The memory of `image` is reused.
  void Render(Simulator& simulator, std::uint32_t frame_index, CameraImage& image) const;
  /// The overload for a begun frame; for several of them at once, as Simulator::Scan().
  void Render(Simulator& simulator, BegunFrame& begun, CameraImage& image) const;

 private:
  CameraSpec spec_;
  Transform vehicle_from_camera_;
  std::vector<Vector3> colors_;  ///< By index of the material: linear red, green and blue.
};

}  // namespace railcast
