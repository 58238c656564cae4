#pragma once

#include <array>
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <numbers>
#include <string>
#include <vector>

#include "railcast/frame.h"
#include "tests/viewer/program/view_program.h"
#include "viewer/color/palette.h"

namespace railcast {

/// Two upright squares of 2 x 2 m at `x_m`, with label 1 straight ahead and label 2 5 m to the
/// left, and a point 80 m nearer.
class Squares : public Drawn {
 protected:
  /// Writes the squares as an ASCII PCD; its last point is absent.
  void WriteSquares(const std::string& name, int x_m = 40) const {
    std::string points = std::to_string(x_m - 80) + " 0 0 0\n";
    int num_points = 2;
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
    const std::string count = std::to_string(num_points);
    Write(name,
          "VERSION 0.7\nFIELDS x y z label\nSIZE 4 4 4 4\nTYPE F F F U\nCOUNT 1 1 1 1\nWIDTH " +
              count + "\nHEIGHT 1\nPOINTS " + count + "\nDATA ascii\n" + points);
  }

  /// Returns the squares as a frame of one row; the last slot has no point.
  static Frame SquaresFrame(std::uint32_t index) {
    std::vector<std::array<float, 3>> points = {{-40.0F, 0.0F, 0.0F}};
    for (int iy = -20; iy <= 20; ++iy) {
      for (int iz = -20; iz <= 20; ++iz) {
        for (int square = 0; square < 2; ++square) {
          points.push_back({40.0F,
                            0.05F * static_cast<float>(iy) + 5.0F * static_cast<float>(square),
                            0.05F * static_cast<float>(iz)});
        }
      }
    }
    Frame frame;
    frame.index = index;
    frame.Resize(1, static_cast<std::uint32_t>(points.size() + 1), 1);
    for (std::size_t i = 0; i < points.size(); ++i) {
      frame.x[i] = points[i][0];
      frame.y[i] = points[i][1];
      frame.z[i] = points[i][2];
    }
    frame.outcome.back() = Outcome::kNoSurface;
    return frame;
  }

  void WriteLabels(const std::string& name) const {
    Write(name, R"({"version": 1, "labels": [
      {"id": 1, "name": "red", "rgb": [255, 0, 0], "whu_railway3d": "Others", "osdar23": "",
       "semantic_kitti": 0, "semantic_kitti_nearest": 0},
      {"id": 2, "name": "green", "rgb": [0, 255, 0], "whu_railway3d": "Others", "osdar23": "",
       "semantic_kitti": 0, "semantic_kitti_nearest": 0}]})");
  }

  /// Draws the squares from the driver's place.
  void DrawSquares(const std::string& arguments) {
    picture_ = Draw("--camera driver " + arguments);
  }

  /// Returns the colour at a number of pixels to the right of and above the picture's centre.
  [[nodiscard]] Rgb At(double right_px, double above_px) const {
    return picture_.At(static_cast<int>(std::lround(320 + right_px)),
                       kHeight - 1 - static_cast<int>(std::lround(240 + above_px)));
  }

  // The camera is at (-1, 0, 0.3) and looks at (60, 0, -1.5) with a vertical field of view of 36
  // deg.
  static constexpr double kTilt = 1.8 / 61.0;
  static double PixelsPerTangent() { return 240.0 / std::tan(18.0 * std::numbers::pi / 180.0); }
  // In the plane at x = 40 m: how many pixels above the centre a height is, and how many pixels a
  // metre has.
  [[nodiscard]] static double PixelsAbove(double z_m) {
    const double angle_rad = std::atan((z_m - 0.3) / 41.0) + std::atan(kTilt);
    return PixelsPerTangent() * std::tan(angle_rad);
  }
  static double MetreInPixels() { return PixelsPerTangent() / 41.0; }

  /// Returns the place of a colour on the scale.
  static double PlaceOnScale(const Rgb& rgb) {
    const auto distance = [&](int step) {
      const Rgb other = MapColor(ColorMap::kViridis, step / 1000.0);
      return std::abs(rgb[0] - other[0]) + std::abs(rgb[1] - other[1]) +
             std::abs(rgb[2] - other[2]);
    };
    int nearest = 0;
    for (int step = 1; step <= 1000; ++step) {
      if (distance(step) < distance(nearest)) nearest = step;
    }
    EXPECT_LE(distance(nearest), 3);
    return nearest / 1000.0;
  }

 private:
  Picture picture_;
};

}  // namespace railcast
