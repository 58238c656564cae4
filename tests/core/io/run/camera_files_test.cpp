#include "core/io/run/camera_files.h"

#include <gtest/gtest.h>

#include <limits>
#include <nlohmann/json.hpp>

#include "core/io/run/sequence_files.h"
#include "core/io/write_file.h"
#include "tests/core/io/message_of.h"
#include "tests/core/io/temporary_directory.h"
#include "tests/support/run_command.h"

namespace railcast {
namespace {

CameraImage ExampleImage() {
  CameraImage image;
  image.width_px = 5;
  image.height_px = 3;
  for (std::uint32_t i = 0; i < 15; ++i) {
    for (const std::uint32_t add : {0U, 80U, 160U}) {
      image.rgb.push_back(static_cast<std::uint8_t>(6 * i + add));
    }
    image.depth_m.push_back(i == 4 ? std::numeric_limits<float>::quiet_NaN()
                                   : 0.1F * static_cast<float>(i));
    image.label.push_back(i);
    image.instance.push_back(65'535 - 1000 * i);
  }
  return image;
}

TEST(CameraFiles, AreNamedByCameraKindAndFrame) {
  const std::vector<std::string> expected = {
      "camera/front/color/000042.png", "camera/front/label/000042.png",
      "camera/front/instance/000042.png", "camera/front/depth/000042.npy"};
  EXPECT_EQ(CameraFileNames("front", 42), expected);
  for (const std::string& name : expected) {
    EXPECT_TRUE(IsSequenceFile(name)) << name;
    EXPECT_TRUE(IsCameraFile(name)) << name;
  }
  EXPECT_TRUE(IsSequenceFile(CalibrationFileName("front")));
  for (const char* stranger : {"camera/front/color/42.png", "camera/front/depth/000042.png",
                               "camera/Front/color/000042.png", "camera/../color/000042.png",
                               "camera/calibration.json", "camera/front/notes.txt"}) {
    EXPECT_FALSE(IsSequenceFile(stranger)) << stranger;
  }
}

// Open3D reads PNG by libpng's interface of its own, and NumPy its own format.
TEST(CameraFiles, AreReadByOtherPrograms) {
  if (!HasOpen3d()) GTEST_SKIP() << "python3-open3d is not installed";
  const TemporaryDirectory directory;
  for (const FrameFile& file : EncodeCameraFiles(ExampleImage(), "front", 0)) {
    const auto path = directory.path() / file.name;
    std::filesystem::create_directories(path.parent_path());
    WriteFileWhole(path, file.bytes);
  }
  const std::string script = R"(
import numpy as np, open3d as o3d
def png(kind): return np.asarray(o3d.io.read_image('camera/front/%s/000000.png' % kind))
i = np.arange(15).reshape(3, 5)
color, label, instance = png('color'), png('label'), png('instance')
assert color.dtype == np.uint8 and (color == 6 * i[..., None] + [0, 80, 160]).all()
assert label.dtype == np.uint16 and (label == i).all()
assert instance.dtype == np.uint16 and (instance == 65535 - 1000 * i).all()
depth = np.load('camera/front/depth/000000.npy')
assert depth.dtype == np.float32 and depth.shape == (3, 5) and np.isnan(depth[0, 4])
assert np.nanmax(abs(depth - np.float32(0.1) * i)) < 1e-6
print('as written')
)";
  WriteFileWhole(directory.path() / "read.py", script);
  EXPECT_EQ(RunCommand("cd " + directory.path().string() + " && /usr/bin/python3 read.py").said,
            "as written\n");
}

TEST(CameraFiles, HoldIdsOf16Bits) {
  CameraImage image = ExampleImage();
  image.instance[3] = 65'536;
  EXPECT_EQ(MessageOf([&] { (void)EncodeCameraFiles(image, "front", 0); }),
            "instance id 65536: must be at most 65535 for a camera's images");
}

TEST(CalibrationFile, SaysWhereAPointIsSeen) {
  const CameraSpec spec{.width_px = 800,
                        .height_px = 600,
                        .horizontal_fov_deg = 90,
                        .name = "front",
                        .distortion = DistortionSpec{0.1, 0.2, 0.3, 0.4, 0.5}};
  Transform vehicle_from_camera = Transform::Identity();
  vehicle_from_camera.linear() << 0, 0, 1, -1, 0, 0, 0, -1, 0;
  vehicle_from_camera.translation() = Vector3(2, 0.5, 3);
  Transform vehicle_from_sensor = Transform::Identity();
  vehicle_from_sensor.translation() = Vector3(2, 0, 2.5);
  const auto json =
      nlohmann::json::parse(CalibrationJson(spec, vehicle_from_camera, vehicle_from_sensor));
  using Rows = std::vector<std::vector<double>>;
  // Focal length: half the width over tan 45 degrees.
  const Rows matrix = json.at("camera_matrix");
  EXPECT_NEAR(matrix[0][0], 400.0, 1e-9);
  EXPECT_NEAR(matrix[1][1], 400.0, 1e-9);
  EXPECT_EQ(matrix[0][2], 399.5);
  EXPECT_EQ(matrix[1][2], 299.5);
  EXPECT_EQ(json.at("distortion_k1_k2_p1_p2_k3"), (std::vector<double>{0.1, 0.2, 0.3, 0.4, 0.5}));
  EXPECT_EQ(Rows(json.at("vehicle_from_camera")),
            (Rows{{0, 0, 1, 2}, {-1, 0, 0, 0.5}, {0, -1, 0, 3}, {0, 0, 0, 1}}));
  EXPECT_EQ(Rows(json.at("sensor_from_camera")),
            (Rows{{0, 0, 1, 0}, {-1, 0, 0, 0.5}, {0, -1, 0, 0.5}, {0, 0, 0, 1}}));
}

}  // namespace
}  // namespace railcast
