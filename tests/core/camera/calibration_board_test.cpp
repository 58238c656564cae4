#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "tests/core/camera/seen.h"
#include "tests/support/scan_once.h"
#include "tests/support/simple_world.h"

namespace railcast {
namespace {

constexpr int kColumns = 8;
constexpr int kRows = 6;
constexpr double kSquare_m = 0.25;

/// A board of black and white squares (labels 1 and 2) before the camera, oblique and turned so
/// that no edge is parallel to rows or columns of pixels.
struct Board {
  Transform camera_from_board =
      MakeTransform(RotationFromYawPitchRoll(0.137, 0.31, -0.23), {0.04, -0.03, 2.6});

  /// The point at column `x` and row `y` of the board's lattice, in optical axes.
  [[nodiscard]] Vector3 At(double x, double y) const {
    return camera_from_board *
           Vector3((x - 0.5 * kColumns) * kSquare_m, (y - 0.5 * kRows) * kSquare_m, 0.0);
  }
  [[nodiscard]] Part Squares(int color) const {
    Part part{.mesh = {}, .material = 1, .label = static_cast<std::uint32_t>(color + 1)};
    const Transform vehicle_from_camera = ForwardOptical();
    for (int y = 0; y < kRows; ++y) {
      for (int x = y % 2 == color ? 0 : 1; x < kColumns; x += 2) {
        const auto first = static_cast<std::uint32_t>(part.mesh.vertices.size());
        for (const auto& [dx, dy] : {std::pair(0, 0), {1, 0}, {1, 1}, {0, 1}}) {
          part.mesh.vertices.push_back((vehicle_from_camera * At(x + dx, y + dy)).cast<float>());
        }
        part.mesh.triangles.push_back({first, first + 1, first + 2});
        part.mesh.triangles.push_back({first, first + 2, first + 3});
      }
    }
    return part;
  }
};

CameraImage ImageOf(const Board& board, const CameraSpec& spec) {
  const auto world = WorldOfParts({board.Squares(0), board.Squares(1)});
  Simulator simulator(world, MakeRaster(10, 10, 1), TestMaterials(), {}, 2);
  CameraImage image;
  Camera(spec, ForwardOptical(), TestMaterials()).Render(simulator, 0, image);
  return image;
}

/// By how much an edge may lie beside its expected place, in pixels across it.
struct Offsets {
  double least_px = -std::numeric_limits<double>::infinity();
  double most_px = std::numeric_limits<double>::infinity();
};

// Intersects the edge between two lattice points with each line of pixels that it crosses (rows if
// `axis` is 0, columns if it is 1). The labels say between which two pixels of that line it runs.
Offsets FindOffsets(const Board& board,
                    const CameraSpec& spec,
                    const CameraImage& image,
                    const std::array<Eigen::Vector2d, 2>& edge,
                    int axis) {
  const auto seen_at = [&](double t) {
    const Eigen::Vector2d place = edge[0] + t * (edge[1] - edge[0]);
    return SeenAt(spec, board.At(place.x(), place.y()));
  };
  const auto label_at = [&](int across, int along) {
    const int column = axis == 0 ? across : along;
    const int row = axis == 0 ? along : across;
    return image
        .label[static_cast<std::size_t>(row) * image.width_px + static_cast<std::size_t>(column)];
  };
  Offsets offsets;
  const double begin = seen_at(0)[1 - axis];
  const double end = seen_at(1)[1 - axis];
  const int last = static_cast<int>(std::floor(std::max(begin, end)));
  for (int line = static_cast<int>(std::floor(std::min(begin, end))) + 1; line <= last; ++line) {
    // Right at the corner the other edge is in the way.
    if (std::abs(line - seen_at(0.5)[1 - axis]) < 3.0) continue;
    double low = 0.0;
    double high = 1.0;
    for (int i = 0; i < 60; ++i) {
      const double middle = 0.5 * (low + high);
      const bool is_before = (seen_at(middle)[1 - axis] < line) == (begin < end);
      (is_before ? low : high) = middle;
    }
    const double place = seen_at(low)[axis];
    // The expected step is between two neighbours; look one further to either side.
    const int expected = static_cast<int>(std::floor(place));
    for (int first = expected - 1; first <= expected + 1; ++first) {
      if (label_at(first, line) == label_at(first + 1, line)) continue;
      offsets.least_px = std::max(offsets.least_px, first - place);
      offsets.most_px = std::min(offsets.most_px, first + 1.0 - place);
    }
  }
  return offsets;
}

// Each inner corner is the crossing of two edges. Every row or column of pixels that an edge
// crosses bounds its place; together these bounds fix it to a small part of a pixel.
double WorstCorner_px(const CameraSpec& spec) {
  const Board board;
  const CameraImage image = ImageOf(board, spec);
  double worst_px = 0.0;
  for (int y = 1; y < kRows; ++y) {
    for (int x = 1; x < kColumns; ++x) {
      // Up to a tenth of a square beside the neighbouring corners.
      const Eigen::Vector2d corner(x, y);
      for (const int axis : {0, 1}) {
        const Eigen::Vector2d way = axis == 0 ? Eigen::Vector2d(0, 0.9) : Eigen::Vector2d(0.9, 0);
        const Offsets offsets = FindOffsets(board, spec, image, {corner - way, corner + way}, axis);
        worst_px = std::max({worst_px, std::abs(offsets.least_px), std::abs(offsets.most_px)});
      }
    }
  }
  return worst_px;
}

const CameraSpec kPinhole{.width_px = 1280, .height_px = 960, .horizontal_fov_deg = 60};

TEST(CalibrationBoard, HasItsCornersWithinATenthOfAPixel) {
  EXPECT_LT(WorstCorner_px(kPinhole), 0.1);
}

TEST(CalibrationBoard, HasItsCornersWithinATenthOfAPixelThroughADistortingLens) {
  CameraSpec spec = kPinhole;
  spec.distortion = DistortionSpec{-0.31, 0.12, 0.002, -0.003, -0.02};
  EXPECT_LT(WorstCorner_px(spec), 0.1);
}

}  // namespace
}  // namespace railcast
