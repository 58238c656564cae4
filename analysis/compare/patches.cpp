#include "analysis/compare/patches.h"

#include <Eigen/Core>
#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <numbers>
#include <span>
#include <tuple>

#include "analysis/estimate/streams.h"

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

// Sums over points from which their covariance follows.
struct Spread {
  std::uint32_t num{};
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  Eigen::Matrix3d squares = Eigen::Matrix3d::Zero();

  void Add(const Eigen::Vector3d& point_m) {
    ++num;
    sum += point_m;
    squares += point_m * point_m.transpose();
  }
  [[nodiscard]] Eigen::Matrix3d Covariance() const {
    const Eigen::Vector3d mean_m = sum / num;
    return squares / num - mean_m * mean_m.transpose();
  }
};

// Standard deviations along the principal axes, the least first.
Eigen::Vector3d DeviationsOf(const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>& axes) {
  return axes.eigenvalues().cwiseMax(0.0).cwiseSqrt();
}

std::size_t CellOfPoint(const Eigen::Vector3d& in_cube_m) {
  std::size_t cell = 0;
  for (const double coordinate_m : in_cube_m) {
    const auto at = static_cast<int>(coordinate_m * kCellsAnEdge / kPatchEdge_m);
    cell = cell * kCellsAnEdge + static_cast<std::size_t>(std::clamp(at, 0, kCellsAnEdge - 1));
  }
  return cell;
}

float RoughnessOf_m(std::span<const Spread> cells) {
  std::vector<double> deviations_m;
  for (const Spread& cell : cells) {
    if (cell.num < kMinCellPoints) continue;
    deviations_m.push_back(DeviationsOf(Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>(
        cell.Covariance(), Eigen::EigenvaluesOnly))[0]);
  }
  if (deviations_m.empty()) return kUnknown;
  const auto middle = deviations_m.begin() + static_cast<std::ptrdiff_t>(deviations_m.size() / 2);
  std::ranges::nth_element(deviations_m, middle);
  return static_cast<float>(*middle);
}

// The features that follow from the positions alone, in their order.
std::vector<double> ShapeFeatures(const Spread& points,
                                  std::span<const Spread> cells,
                                  double range_m) {
  const Eigen::Matrix3d covariance = points.Covariance();
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> axes(covariance);
  const Eigen::Vector3d deviations_m = DeviationsOf(axes);
  const double largest_m = std::max(deviations_m[2], std::numeric_limits<double>::min());
  const double upright = std::min(std::abs(axes.eigenvectors().col(0).z()), 1.0);
  const auto num_filled = std::ranges::count_if(cells, [](const Spread& c) { return c.num > 0; });
  // The solid angle of a square of the cube's edge that faces the sensor.
  const double solid_angle_sr = kPatchEdge_m * kPatchEdge_m / (range_m * range_m);
  return {(deviations_m[2] - deviations_m[1]) / largest_m,
          (deviations_m[1] - deviations_m[0]) / largest_m,
          deviations_m[0] / largest_m,
          deviations_m[0],
          static_cast<double>(RoughnessOf_m(cells)),
          std::acos(upright) * 180.0 / std::numbers::pi,
          std::sqrt(std::max(covariance(2, 2), 0.0)),
          points.num / solid_angle_sr,
          kWhole_percent * static_cast<double>(num_filled) / kNumCells};
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
  Spread all;
  std::array<Spread, kNumCells> cells;
  Moments intensities;
  for (const auto& [cube, slot] : points) {
    const Frame& frame = recorded.frame;
    const Eigen::Vector3d in_cube_m =
        Eigen::Vector3f(frame.x[slot], frame.y[slot], frame.z[slot]).cast<double>() - corner_m;
    all.Add(in_cube_m);
    cells.at(CellOfPoint(in_cube_m)).Add(in_cube_m);
    if (recorded.Has("intensity")) intensities.Add(static_cast<double>(frame.intensity[slot]));
  }
  const double range_m = (corner_m + all.sum / all.num).norm();
  Patch patch;
  patch.range_m = static_cast<float>(range_m);
  auto next = patch.features.begin();
  for (const double feature : ShapeFeatures(all, cells, range_m)) {
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
