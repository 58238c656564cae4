#include <gtest/gtest.h>

#include "core/io/run/camera_files.h"
#include "tests/core/io/temporary_directory.h"
#include "tests/generator/example_run.h"

namespace railcast {
namespace {

SequenceSpec RunWithCamera(const std::filesystem::path& directory, const std::string& format) {
  SequenceSpec spec = ExampleRun(directory, format);
  spec.camera = "front";
  spec.calibration_json = "{}\n";
  return spec;
}

// An image with every second frame: those with even numbers.
bool MakeExampleImage(std::uint32_t index, CameraImage& image) {
  if (index % 2 != 0) return false;
  image.width_px = 2;
  image.height_px = 1;
  image.rgb.assign(6, static_cast<std::uint8_t>(index));
  image.depth_m = {1.5F, static_cast<float>(index)};
  image.label = {1, index};
  image.instance = {0, 3};
  return true;
}

SequenceResult MakeRun(const SequenceSpec& spec, const SequenceHooks& hooks = NoHooks()) {
  return RunSequence(spec, MakeExampleFrame, hooks, MakeExampleImage);
}

TEST(CameraSequence, HasImagesAndCalibrationBesideTheClouds) {
  for (const std::string format : {"pcd", "kitti"}) {
    const TemporaryDirectory directory;
    EXPECT_TRUE(MakeRun(RunWithCamera(directory.path(), format)).is_complete);
    auto contents = Contents(directory.path());
    EXPECT_EQ(contents.at("camera/front/calibration.json"), "{}\n");
    // Frames 3 to 8; KITTI's are numbered from 0.
    for (const std::uint32_t frame : {4U, 6U, 8U}) {
      CameraImage image;
      ASSERT_TRUE(MakeExampleImage(frame, image));
      const std::uint32_t number = format == "kitti" ? frame - 3 : frame;
      for (const FrameFile& file : EncodeCameraFiles(image, "front", number)) {
        EXPECT_EQ(contents.at(file.name), file.bytes) << file.name;
      }
    }
    EXPECT_EQ(contents.contains("camera/front/color/000005.png"), format == "kitti");
    // Without the camera, all other files of the frames would be the same.
    const TemporaryDirectory other;
    (void)RunSequence(ExampleRun(other.path(), format), MakeExampleFrame, NoHooks());
    for (const auto& [name, bytes] : Contents(other.path())) {
      if (name == "frames.jsonl" || name == "manifest.json") continue;
      EXPECT_EQ(contents.at(name), bytes) << name;
    }
  }
}

TEST(CameraSequence, ContinuesAfterAnInterruptionWithTheSameBytes) {
  const TemporaryDirectory undisturbed;
  (void)MakeRun(RunWithCamera(undisturbed.path(), "pcd"));
  const auto expected = Contents(undisturbed.path());
  const TemporaryDirectory directory;
  std::uint32_t num_done = 0;
  const SequenceHooks stop_after_three = {
      [&](std::uint32_t done, std::uint32_t) { num_done = done; }, [&] { return num_done >= 3; }};
  EXPECT_FALSE(MakeRun(RunWithCamera(directory.path(), "pcd"), stop_after_three).is_complete);
  // An image that was damaged and one that was not finished are made anew.
  WriteFileWhole(directory.path() / "camera/front/label/000004.png", "damaged");
  WriteFileWhole(directory.path() / "camera/front/depth/000008.npy.part", "begun");
  EXPECT_TRUE(MakeRun(RunWithCamera(directory.path(), "pcd")).is_complete);
  EXPECT_EQ(Contents(directory.path()), expected);
}

TEST(CameraSequence, NoticesAnImageThatWasChanged) {
  const TemporaryDirectory directory;
  (void)MakeRun(RunWithCamera(directory.path(), "pcd"));
  WriteFileWhole(directory.path() / "camera/front/color/000006.png", "changed");
  EXPECT_EQ(
      MakeRun(RunWithCamera(directory.path(), "pcd")).changed,
      std::vector<std::string>{directory.path().string() + ": frame 6 was changed or removed"});
}

}  // namespace
}  // namespace railcast
