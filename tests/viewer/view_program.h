#pragma once

#include <gtest/gtest.h>
#include <sys/wait.h>
#include <vtkImageData.h>
#include <vtkNew.h>
#include <vtkPNGReader.h>
#include <vtkSmartPointer.h>

#include <array>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <numbers>
#include <string>

#include "viewer/coloring.h"

namespace railcast {

struct Result {
  int exit_code{};
  std::string output;
};

inline Result Execute(const std::string& command) {
  Result result;
  FILE* const pipe = popen((command + " 2>&1").c_str(), "r");
  std::array<char, 256> text{};
  while (std::fgets(text.data(), text.size(), pipe) != nullptr) result.output += text.data();
  result.exit_code = WEXITSTATUS(pclose(pipe));
  return result;
}

/// A folder for one test, removed afterwards.
class RailcastView : public testing::Test {
 protected:
  RailcastView() { std::filesystem::create_directories(folder_); }
  ~RailcastView() override { std::filesystem::remove_all(folder_); }

  std::string PathOf(const std::string& name) const { return folder_ / name; }

  void Write(const std::string& name, const std::string& text) const {
    std::filesystem::create_directories((folder_ / name).parent_path());
    std::ofstream(folder_ / name) << text;
  }

  /// Two upright squares of 2 x 2 m at `x_m`: label 1 straight ahead, label 2 5 m to the left; and
  /// a point 80 m nearer.
  void WriteSquares(const std::string& name, int x_m = 40) const {
    std::string points = std::to_string(x_m - 80) + " 0 0 0\n";
    int num_points = 1;
    for (int iy = -20; iy <= 20; ++iy) {
      for (int iz = -20; iz <= 20; ++iz) {
        for (int label = 1; label <= 2; ++label) {
          points += std::to_string(x_m) + ' ' + std::to_string(0.05 * iy + 5.0 * (label - 1)) +
                    ' ' + std::to_string(0.05 * iz) + ' ' + std::to_string(label) + '\n';
          ++num_points;
        }
      }
    }
    points += "nan nan nan 0\n";
    ++num_points;
    const std::string count = std::to_string(num_points);
    Write(name,
          "VERSION 0.7\nFIELDS x y z label\nSIZE 4 4 4 4\nTYPE F F F U\nCOUNT 1 1 1 1\nWIDTH " +
              count + "\nHEIGHT 1\nPOINTS " + count + "\nDATA ascii\n" + points);
  }

  void WriteLabels(const std::string& name) const {
    Write(name, R"({"version": 1, "labels": [
      {"id": 1, "name": "red", "rgb": [255, 0, 0], "whu_railway3d": "Others", "osdar23": "",
       "semantic_kitti": 0, "semantic_kitti_nearest": 0},
      {"id": 2, "name": "green", "rgb": [0, 255, 0], "whu_railway3d": "Others", "osdar23": "",
       "semantic_kitti": 0, "semantic_kitti_nearest": 0}]})");
  }

 private:
  const std::filesystem::path folder_ =
      testing::TempDir() + testing::UnitTest::GetInstance()->current_test_info()->name();
};

// A server that resets when its last client leaves signals xvfb-run once more, and on a busy
// machine xvfb-run takes that signal for a failed clean-up: hence -noreset.
inline constexpr char kOnADisplay[] =
    "xvfb-run -a -s '-noreset -screen 0 1280x1024x24' " RAILCAST_VIEW;

/// The tests that draw need a display; Xvfb is one without a screen.
class Screenshot : public RailcastView {
 protected:
  void SetUp() override {
    if (std::system("command -v xvfb-run >/dev/null") != 0) GTEST_SKIP() << "xvfb-run is missing";
  }

  /// Draws 640 x 480 from the driver's place.
  void Draw(const std::string& arguments) {
    const Result result = Execute(std::string(kOnADisplay) +
                                  " --size 640x480 --camera driver"
                                  " --screenshot " +
                                  PathOf("out.png") + ' ' + arguments);
    ASSERT_EQ(result.exit_code, 0) << result.output;
    vtkNew<vtkPNGReader> reader;
    reader->SetFileName(PathOf("out.png").c_str());
    reader->Update();
    image_ = reader->GetOutput();
    ASSERT_EQ(image_->GetDimensions()[0], 640);
    ASSERT_EQ(image_->GetDimensions()[1], 480);
  }

  /// The colour at a number of pixels to the right of and above the picture's centre.
  Rgb At(double right_px, double above_px) const {
    const int x = static_cast<int>(std::lround(320 + right_px));
    const int y = static_cast<int>(std::lround(240 + above_px));
    const auto* const pixel = static_cast<const unsigned char*>(image_->GetScalarPointer(x, y, 0));
    return {pixel[0], pixel[1], pixel[2]};
  }

  // The camera is at (-1, 0, 0.3) and looks at (60, 0, -1.5) with 36 deg from bottom to top.
  static constexpr double kTilt = 1.8 / 61.0;
  static double PixelsPerTangent() { return 240.0 / std::tan(18.0 * std::numbers::pi / 180.0); }
  // Of the plane at x = 40 m: how far above the centre its axis is at a height, and one metre.
  double PixelsAbove(double z_m) const {
    const double angle_rad = std::atan((z_m - 0.3) / 41.0) + std::atan(kTilt);
    return PixelsPerTangent() * std::tan(angle_rad);
  }
  static double MetreInPixels() { return PixelsPerTangent() / 41.0; }

 private:
  vtkSmartPointer<vtkImageData> image_;
};

/// Where on the scale a colour is.
inline double PlaceOnScale(const Rgb& rgb) {
  const auto distance = [&](int step) {
    const Rgb other = ScaleColor(step / 1000.0);
    return std::abs(rgb[0] - other[0]) + std::abs(rgb[1] - other[1]) + std::abs(rgb[2] - other[2]);
  };
  int nearest = 0;
  for (int step = 1; step <= 1000; ++step) {
    if (distance(step) < distance(nearest)) nearest = step;
  }
  EXPECT_LE(distance(nearest), 3);
  return nearest / 1000.0;
}

}  // namespace railcast
