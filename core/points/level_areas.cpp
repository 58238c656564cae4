#include "core/points/level_areas.h"

#include <Eigen/Cholesky>
#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <map>
#include <utility>

namespace railcast {
namespace {

constexpr double kCell_m = 0.5;
constexpr double kFarthest_m = 25.0;
constexpr double kNear_m = 0.1;      // From a plane.
constexpr double kApart_m = 0.25;    // Between planes, at the sensor.
constexpr double kMostSlope = 0.17;  // The tangent of 10 degrees.
// The tangent of 2 degrees. A ring that is less steep meets walls at about one height, as if they
// were level.
constexpr double kLeastDepression = 0.035;

/// A plane as z = height + slope . (x, y).
struct LevelPlane {
  double height_m{};
  Eigen::Vector2d slope = Eigen::Vector2d::Zero();

  [[nodiscard]] double Above_m(const Eigen::Vector3d& place_m) const {
    return place_m.z() - height_m - slope.dot(place_m.head<2>());
  }
};

/// The middles of the squares whose points are level.
std::vector<Eigen::Vector3d> LevelCells(const std::vector<Eigen::Vector3f>& points_m) {
  constexpr float kMostSpread_m = 0.2F;
  struct Cell {
    Eigen::Vector3d sum_m = Eigen::Vector3d::Zero();
    double num{};
    float lowest_m{}, highest_m{};
  };
  std::map<std::array<std::int32_t, 2>, Cell> cells;
  for (const Eigen::Vector3f& point_m : points_m) {
    const double way_m = std::hypot(double{point_m.x()}, double{point_m.y()});
    const double below_m = -double{point_m.z()};
    // Negated so that NaN fails, too.
    if (!(way_m < kFarthest_m && below_m > kLeastDepression * way_m)) continue;
    if (way_m < kOwn_m && below_m < kOwnBelow_m) continue;
    const auto place = [](float along_m) {
      return static_cast<std::int32_t>(std::floor(double{along_m} / kCell_m));
    };
    Cell& cell = cells[{place(point_m.x()), place(point_m.y())}];
    const bool is_first = cell.num == 0.0;
    cell.lowest_m = is_first ? point_m.z() : std::min(cell.lowest_m, point_m.z());
    cell.highest_m = is_first ? point_m.z() : std::max(cell.highest_m, point_m.z());
    cell.sum_m += point_m.cast<double>();
    cell.num += 1.0;
  }
  std::vector<Eigen::Vector3d> middles_m;
  for (const auto& [place, cell] : cells) {
    if (cell.highest_m - cell.lowest_m > kMostSpread_m) continue;
    middles_m.emplace_back(cell.sum_m / cell.num);
  }
  return middles_m;
}

/// The plane through three of the cells.
bool PlaneThrough(const std::array<Eigen::Vector3d, 3>& places_m, LevelPlane& plane) {
  const Eigen::Vector3d normal =
      (places_m[1] - places_m[0]).cross(places_m[2] - places_m[0]).normalized();
  if (!(std::abs(normal.z()) > 0.9)) return false;
  plane.slope = -normal.head<2>() / normal.z();
  plane.height_m = places_m[0].z() - plane.slope.dot(places_m[0].head<2>());
  return plane.slope.norm() < kMostSlope;
}

/// Least squares through the cells near a plane.
LevelPlane Refined(const std::vector<Eigen::Vector3d>& cells_m, const LevelPlane& plane) {
  Eigen::Matrix3d normal = Eigen::Matrix3d::Zero();
  Eigen::Vector3d right = Eigen::Vector3d::Zero();
  for (const Eigen::Vector3d& cell_m : cells_m) {
    if (std::abs(plane.Above_m(cell_m)) > kNear_m) continue;
    const Eigen::Vector3d row(1.0, cell_m.x(), cell_m.y());
    normal += row * row.transpose();
    right += row * cell_m.z();
  }
  const Eigen::Vector3d solution = normal.ldlt().solve(right);
  const LevelPlane refined{solution[0], solution.tail<2>()};
  return solution.allFinite() && refined.slope.norm() < kMostSlope ? refined : plane;
}

std::size_t NumNear(const std::vector<Eigen::Vector3d>& cells_m, const LevelPlane& plane) {
  return static_cast<std::size_t>(std::ranges::count_if(
      cells_m, [&](const Eigen::Vector3d& m) { return std::abs(plane.Above_m(m)) <= kNear_m; }));
}

/// The plane near which most cells are, of those through many triples, spread evenly (Roberts 2018,
/// the additive sequence of the root of x^4 = x + 1).
std::pair<LevelPlane, std::size_t> BestPlane(const std::vector<Eigen::Vector3d>& cells_m) {
  constexpr int kTries = 400;
  constexpr double kRoot = 1.2207440846057596;
  std::pair<LevelPlane, std::size_t> best;
  for (int i = 1; i <= kTries; ++i) {
    std::array<Eigen::Vector3d, 3> places_m;
    double step = 1.0;
    for (Eigen::Vector3d& place_m : places_m) {
      step /= kRoot;
      const double turn = step * i - std::floor(step * i);
      place_m = cells_m[static_cast<std::size_t>(turn * static_cast<double>(cells_m.size()))];
    }
    LevelPlane plane;
    if (!PlaneThrough(places_m, plane)) continue;
    const std::size_t num = NumNear(cells_m, plane);
    if (num > best.second) best = {plane, num};
  }
  for (int pass = 0; pass < 2 && best.second > 0; ++pass) {
    best.first = Refined(cells_m, best.first);
    best.second = NumNear(cells_m, best.first);
  }
  return best;
}

}  // namespace

std::vector<LevelArea> FindLevelAreas(const std::vector<Eigen::Vector3f>& points_m) {
  constexpr std::size_t kMost = 4;
  constexpr std::size_t kFewestCells = 20;
  constexpr double kLeastShare = 0.2;
  std::vector<Eigen::Vector3d> cells_m = LevelCells(points_m);
  const double least = kLeastShare * static_cast<double>(cells_m.size());
  std::vector<LevelArea> areas;
  while (areas.size() < kMost && cells_m.size() >= kFewestCells) {
    const auto [plane, num] = BestPlane(cells_m);
    if (num < kFewestCells || static_cast<double>(num) < least) break;
    std::erase_if(cells_m, [&](const Eigen::Vector3d& cell_m) {
      return std::abs(plane.Above_m(cell_m)) <= kApart_m;
    });
    const double area_m2 = kCell_m * kCell_m * static_cast<double>(num);
    const auto same = std::ranges::find_if(areas, [&](const LevelArea& area) {
      return std::abs(area.below_m + plane.height_m) <= kApart_m;
    });
    if (same != areas.end()) {
      same->area_m2 += area_m2;
    } else {
      areas.push_back({-plane.height_m, area_m2});
    }
  }
  std::erase_if(areas, [](const LevelArea& area) { return area.below_m <= 0.0; });
  std::ranges::stable_sort(areas, std::greater(), &LevelArea::area_m2);
  return areas;
}

GroundBelow FindGroundBelow(const std::vector<Eigen::Vector3f>& points_m) {
  const std::vector<LevelArea> areas = FindLevelAreas(points_m);
  GroundBelow ground;
  if (areas.empty()) return ground;
  if (areas.size() > 1 && areas[1].area_m2 > 0.5 * areas[0].area_m2) {
    ground.rivals = {areas[0], areas[1]};
    return ground;
  }
  ground.is_found = true;
  ground.below_m = areas[0].below_m;
  return ground;
}

}  // namespace railcast
