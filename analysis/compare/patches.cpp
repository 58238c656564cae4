#include "analysis/compare/separability.h"

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <span>
#include <tuple>

#include "analysis/estimate/streams.h"
#include "core/base/median.h"
#include "core/points/point_spread.h"

namespace railcast {
namespace {

constexpr int kCellsAnEdge = 4;  // 0.5 m.
constexpr std::size_t kNumCells = std::size_t{kCellsAnEdge} * kCellsAnEdge * kCellsAnEdge;
// A plane through three points has no deviations; twice as many estimate it.
constexpr std::uint32_t kMinCellPoints = 6;
// Points beyond this, as a faulty foreign file may hold, are left out.
constexpr float kFarthestPatch_m = 1e5F;
constexpr double kWhole_percent = 100.0;
constexpr float kUnknown = std::numeric_limits<float>::quiet_NaN();

using Cube = std::tuple<std::int32_t, std::int32_t, std::int32_t>;

struct PointInCube {
  Cube cube;
  std::uint32_t slot{};
  auto operator<=>(const PointInCube&) const = default;
};

std::int32_t CubeOf(float coordinate_m) {
  return static_cast<std::int32_t>(std::floor(static_cast<double>(coordinate_m) / kPatchEdge_m));
}

std::vector<PointInCube> SortedByCube(const Frame& frame) {
  std::vector<PointInCube> points;
  for (std::size_t slot = 0; slot < frame.num_slots(); ++slot) {
    const float x = frame.x[slot], y = frame.y[slot], z = frame.z[slot];
    const float farthest_m = std::max({std::abs(x), std::abs(y), std::abs(z)});
    if (!std::isfinite(x + y + z) || farthest_m > kFarthestPatch_m) continue;
    points.push_back({{CubeOf(x), CubeOf(y), CubeOf(z)}, static_cast<std::uint32_t>(slot)});
  }
  std::ranges::sort(points);
  return points;
}

// Relative to the cube's corner.
using PointsInCube = std::vector<Eigen::Vector3f>;

std::size_t CellOfPoint(const Eigen::Vector3f& in_cube_m) {
  std::size_t cell = 0;
  for (const double coordinate_m : in_cube_m.cast<double>()) {
    const auto at = static_cast<int>(coordinate_m * kCellsAnEdge / kPatchEdge_m);
    cell = cell * kCellsAnEdge + static_cast<std::size_t>(std::clamp(at, 0, kCellsAnEdge - 1));
  }
  return cell;
}

float RoughnessOf_m(std::span<const PointsInCube> cells) {
  std::vector<double> deviations_m;
  for (const PointsInCube& cell : cells) {
    if (cell.size() < kMinCellPoints) continue;
    deviations_m.push_back(std::sqrt(SpreadOf(cell).variances_m2[0]));
  }
  return static_cast<float>(MedianOf(deviations_m));
}

// The features that follow from the positions alone, in their order.
std::vector<double> ShapeFeatures(const PointSpread& spread,
                                  std::size_t num_points,
                                  std::span<const PointsInCube> cells,
                                  double range_m) {
  // Along the principal axes, the least first.
  const Eigen::Vector3d deviations_m = spread.variances_m2.cwiseSqrt();
  const double largest_m = std::max(deviations_m[2], std::numeric_limits<double>::min());
  const double upright = std::min(std::abs(spread.axes.col(0).z()), 1.0);
  const auto num_empty = std::ranges::count_if(cells, &PointsInCube::empty);
  // The solid angle of a square of the cube's edge that faces the sensor.
  const double solid_angle_sr = kPatchEdge_m * kPatchEdge_m / (range_m * range_m);
  return {(deviations_m[2] - deviations_m[1]) / largest_m,
          (deviations_m[1] - deviations_m[0]) / largest_m,
          deviations_m[0] / largest_m,
          deviations_m[0],
          static_cast<double>(RoughnessOf_m(cells)),
          std::acos(upright) * 180.0 / std::numbers::pi,
          std::sqrt(spread.covariance_m2(2, 2)),
          static_cast<double>(num_points) / solid_angle_sr,
          kWhole_percent * static_cast<double>(std::ssize(cells) - num_empty) / kNumCells};
}

float ShareWithOthers_percent(const RecordedFrame& recorded, std::span<const PointInCube> points) {
  if (!recorded.Has("return_count")) return kUnknown;
  const auto num = std::ranges::count_if(points, [&](const PointInCube& point) {
    return recorded.frame.return_count[point.slot] > 1;
  });
  return static_cast<float>(kWhole_percent * static_cast<double>(num) /
                            static_cast<double>(points.size()));
}

Patch MakePatch(const RecordedFrame& recorded, std::span<const PointInCube> points) {
  const auto [x, y, z] = points.front().cube;
  const Eigen::Vector3d corner_m = kPatchEdge_m * Eigen::Vector3d(x, y, z);
  PointsInCube all;
  std::array<PointsInCube, kNumCells> cells;
  Moments intensities;
  for (const auto& [cube, slot] : points) {
    const Frame& frame = recorded.frame;
    const Eigen::Vector3f in_cube_m =
        Eigen::Vector3f(frame.x[slot], frame.y[slot], frame.z[slot]) - corner_m.cast<float>();
    all.push_back(in_cube_m);
    cells.at(CellOfPoint(in_cube_m)).push_back(in_cube_m);
    if (recorded.Has("intensity")) intensities.Add(static_cast<double>(frame.intensity[slot]));
  }
  const PointSpread spread = SpreadOf(all);
  const double range_m = (corner_m + spread.mean_m).norm();
  Patch patch;
  patch.range_m = static_cast<float>(range_m);
  auto next = patch.features.begin();
  for (const double feature : ShapeFeatures(spread, all.size(), cells, range_m)) {
    *next++ = static_cast<float>(feature);
  }
  *next++ = ShareWithOthers_percent(recorded, points);
  *next++ = static_cast<float>(intensities.PlainMean());
  *next++ = static_cast<float>(intensities.StandardDeviation().value);
  return patch;
}

}  // namespace

std::vector<Patch> PatchesOf(const RecordedFrame& recorded) {
  const std::vector<PointInCube> points = SortedByCube(recorded.frame);
  std::vector<std::span<const PointInCube>> cubes;
  for (auto begin = points.begin(); begin != points.end();) {
    const auto end = std::find_if(
        begin, points.end(), [&](const PointInCube& point) { return point.cube != begin->cube; });
    if (static_cast<std::size_t>(end - begin) >= kMinPatchPoints) cubes.emplace_back(begin, end);
    begin = end;
  }
  const std::size_t num = std::min(cubes.size(), kMaxPatchesAFrame);
  std::vector<Patch> patches;
  for (std::size_t i = 0; i < num; ++i) {
    patches.push_back(MakePatch(recorded, cubes[i * cubes.size() / num]));
  }
  return patches;
}

}  // namespace railcast
