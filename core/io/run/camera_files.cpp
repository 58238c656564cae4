#include "core/io/run/camera_files.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cstring>
#include <nlohmann/json.hpp>

#include "core/base/error.h"
#include "core/base/text.h"
#include "core/io/image/png.h"
#include "core/io/run/sequence_files.h"

namespace railcast {
namespace {

using OrderedJson = nlohmann::ordered_json;

std::string FolderOf(std::string_view camera) {
  return std::string(kCameraFolder) + "/" + std::string(camera) + "/";
}

OrderedJson Rows(const Eigen::MatrixXd& matrix) {
  OrderedJson rows = OrderedJson::array();
  for (Eigen::Index row = 0; row < matrix.rows(); ++row) {
    OrderedJson values = OrderedJson::array();
    for (Eigen::Index column = 0; column < matrix.cols(); ++column) {
      values.push_back(matrix(row, column) + 0.0);  // No negative zeros.
    }
    rows.push_back(std::move(values));
  }
  return rows;
}

// Writes each matrix with one row a line, as people read it.
std::string WithRowsOnLines(const OrderedJson& object) {
  std::string text = "{\n";
  for (auto member = object.begin(); member != object.end(); ++member) {
    text += "  " + OrderedJson(member.key()).dump() + ": ";
    const bool is_matrix = member->is_array() && !member->empty() && member->front().is_array();
    if (is_matrix) {
      text += "[\n";
      for (const OrderedJson& row : *member) {
        text += "    " + row.dump() + (&row == &member->back() ? "\n" : ",\n");
      }
      text += "  ]";
    } else {
      text += member->dump();
    }
    text += std::next(member) == object.end() ? "\n" : ",\n";
  }
  return text + "}\n";
}

void CheckIds(const std::vector<std::uint32_t>& ids, const std::string& what) {
  constexpr std::uint32_t kMost = 65'535;
  const auto most = std::ranges::max_element(ids);
  if (most == ids.end() || *most <= kMost) return;
  throw InputError(what + " id " + NumberText(*most) +
                   ": must be at most 65535 for a camera's images");
}

}  // namespace

std::vector<std::string> CameraFileNames(std::string_view camera, std::uint32_t number) {
  std::vector<std::string> names;
  for (const FrameFileKind& kind : CameraFileKinds()) {
    names.push_back(FolderOf(camera) + std::string(kind.folder) + FrameDigits(number) +
                    std::string(kind.extension));
  }
  return names;
}

std::vector<FrameFile> EncodeCameraFiles(const CameraImage& image,
                                         std::string_view camera,
                                         std::uint32_t number) {
  CheckIds(image.label, "label");
  CheckIds(image.instance, "instance");
  const ImageSize size{image.width_px, image.height_px};
  const std::array bytes = {EncodePngRgb(size, image.rgb), EncodePngGrey16(size, image.label),
                            EncodePngGrey16(size, image.instance),
                            EncodeNpy(image.width_px, image.height_px, image.depth_m)};
  const std::vector<std::string> names = CameraFileNames(camera, number);
  Check(names.size() == bytes.size(), "each kind of image is encoded");
  std::vector<FrameFile> files;
  for (std::size_t i = 0; i < names.size(); ++i) files.push_back({names[i], bytes[i]});
  return files;
}

std::string CalibrationFileName(std::string_view camera) {
  return FolderOf(camera) + std::string(kCalibrationName);
}

std::string CalibrationJson(const CameraSpec& spec,
                            const Transform& vehicle_from_camera,
                            const Transform& vehicle_from_sensor) {
  const Intrinsics k = IntrinsicsOf(spec);
  Eigen::Matrix3d matrix;
  matrix << k.focal_px, 0, k.cx_px, 0, k.focal_px, k.cy_px, 0, 0, 1;
  const DistortionSpec d = spec.distortion.value_or(DistortionSpec{});
  const Transform sensor_from_camera = vehicle_from_sensor.inverse() * vehicle_from_camera;
  const OrderedJson calibration = {
      {"name", spec.name},
      {"width_px", spec.width_px},
      {"height_px", spec.height_px},
      {"axes", "optical: x right, y down, z forward; (0, 0) is the centre of the upper left pixel"},
      {"camera_matrix", Rows(matrix)},
      {"distortion_model", "brown_conrady"},
      {"distortion_k1_k2_p1_p2_k3", {d.k1, d.k2, d.p1, d.p2, d.k3}},
      {"depth", "z along the optical axis in m; NaN = no surface within range"},
      {"vehicle_from_camera", Rows(vehicle_from_camera.matrix())},
      {"sensor_from_camera", Rows(sensor_from_camera.matrix())}};
  return WithRowsOnLines(calibration);
}

std::string NpyHeader(const std::string& type, const std::string& shape) {
  static_assert(std::endian::native == std::endian::little);
  // Data begin at a multiple of 64 bytes; the two bytes before the header hold its length.
  constexpr std::size_t kAlignment = 64;
  constexpr std::string_view kMagic("\x93NUMPY\x01\x00", 8);
  std::string header = "{'descr': " + type + ", 'fortran_order': False, 'shape': " + shape + ", }";
  const std::size_t unpadded = kMagic.size() + 2 + header.size() + 1;
  header.append((kAlignment - unpadded % kAlignment) % kAlignment, ' ');
  header += '\n';
  std::string bytes(kMagic);
  bytes += static_cast<char>(header.size() & 0xFFU);
  bytes += static_cast<char>(header.size() >> 8U);
  return bytes += header;
}

std::string EncodeNpy(std::uint32_t width_px,
                      std::uint32_t height_px,
                      const std::vector<float>& values) {
  std::string shape = "(";
  shape += NumberText(height_px);
  shape += ", ";
  shape += NumberText(width_px);
  shape += ')';
  std::string bytes = NpyHeader("'<f4'", shape);
  const std::size_t first = bytes.size();
  bytes.resize(first + values.size() * sizeof(float));
  if (!values.empty()) std::memcpy(&bytes[first], values.data(), values.size() * sizeof(float));
  return bytes;
}

}  // namespace railcast
