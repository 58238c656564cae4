#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "railcast/camera.h"
#include "railcast/io/cloud_files.h"
#include "railcast/transform.h"

namespace railcast {

// The files of a sequence directory that hold a camera's images (docs/files.md), in the folder
// camera/NAME.

/// The names of an image's files relative to the sequence directory: colour, label, instance,
/// depth.
/// @param number As in FrameFileNames().
[[nodiscard]] std::vector<std::string> CameraFileNames(std::string_view camera,
                                                       std::uint32_t number);

/// Encodes an image into these files.
/// @throws InputError if a label's or an instance's id does not fit into 16 bits.
[[nodiscard]] std::vector<FrameFile> EncodeCameraFiles(const CameraImage& image,
                                                       std::string_view camera,
                                                       std::uint32_t number);

/// The name of the camera's calibration file.
[[nodiscard]] std::string CalibrationFileName(std::string_view camera);

/// The calibration file: intrinsics, distortion, and where the optical axes are.
/// @param vehicle_from_sensor Pose of the sensor whose frames the images belong to.
[[nodiscard]] std::string CalibrationJson(const CameraSpec& spec,
                                          const Transform& vehicle_from_camera,
                                          const Transform& vehicle_from_sensor);

/// The header of a NumPy array (.npy, version 1.0), behind which its values stand.
/// @param type As NumPy describes it: "'<f4'".
/// @param shape "(480, 640)".
[[nodiscard]] std::string NpyHeader(const std::string& type, const std::string& shape);

/// Encodes values in rows as a NumPy array (.npy, version 1.0) of little-endian float32.
[[nodiscard]] std::string EncodeNpy(std::uint32_t width_px,
                                    std::uint32_t height_px,
                                    const std::vector<float>& values);

}  // namespace railcast
