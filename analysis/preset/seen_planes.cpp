#include "analysis/preset/seen_planes.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>

#include "analysis/stats/bins.h"
#include "core/base/units.h"

namespace railcast {
namespace {

constexpr std::size_t kMostPlanes = 24;
constexpr double kLeastShare = 0.004;

struct GridPoint {
  Vector3 position_m = Vector3::Zero();
  std::size_t row{};
  std::size_t column{};
};

std::optional<Vector3> PositionAt(const Frame& frame, std::size_t row, std::size_t column) {
  const std::size_t slot = row * frame.width() + column * frame.returns;
  if (!std::isfinite(frame.range_m[slot])) return std::nullopt;
  return Vector3(static_cast<double>(frame.x[slot]), static_cast<double>(frame.y[slot]),
                 static_cast<double>(frame.z[slot]));
}

// The points of a ring near the horizon lie on a plane through the sensor, which is no surface.
bool IsApart(const SeenPlane& plane) {
  constexpr double kLeastApart_m = 0.5;
  return std::abs(plane.normal.dot(plane.middle_m)) >= kLeastApart_m;
}

bool IsOnPlane(const SeenPlane& plane, const Vector3& position_m) {
  constexpr double kTolerance_m = 0.04;
  constexpr double kTolerance = 0.0015;
  constexpr double kAlong = 0.1;
  const double range_m = position_m.norm();
  const double distance_m = std::abs(plane.normal.dot(position_m - plane.middle_m));
  if (distance_m > kTolerance_m + kTolerance * range_m) return false;
  return std::abs(plane.RangeAlong_m(position_m / range_m) - range_m) < kAlong * range_m;
}

// Least squares through the points on the plane.
SeenPlane Refitted(const SeenPlane& plane, const std::vector<GridPoint>& points) {
  SeenPlane fitted;
  Vector3 sum = Vector3::Zero();
  Eigen::Matrix3d squares = Eigen::Matrix3d::Zero();
  for (const GridPoint& point : points) {
    if (!IsOnPlane(plane, point.position_m)) continue;
    const Vector3 from_middle = point.position_m - plane.middle_m;
    // Weighted by range, since the tolerance grows and far points are few.
    sum += from_middle;
    squares += from_middle * from_middle.transpose();
    ++fitted.num_points;
  }
  if (fitted.num_points < 3) return plane;
  const auto num = static_cast<double>(fitted.num_points);
  const Vector3 mean = sum / num;
  Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver;
  solver.computeDirect(squares / num - mean * mean.transpose());
  fitted.middle_m = plane.middle_m + mean;
  fitted.normal = solver.eigenvectors().col(0);
  return fitted;
}

// A plane through a point, one in the same ring and one in another ring.
std::optional<SeenPlane> PlaneThrough(const Frame& frame,
                                      const ScanTable& scan,
                                      const GridPoint& point) {
  constexpr std::size_t kColumns = 8;
  const std::size_t rows = std::max<std::size_t>(1, frame.rows / 32);
  if (point.row + rows >= frame.rows || point.column + kColumns >= frame.columns) {
    return std::nullopt;
  }
  const auto above_column = scan.ColumnBeside(point.row, point.column, point.row + rows);
  if (!above_column) return std::nullopt;
  const auto beside = PositionAt(frame, point.row, point.column + kColumns);
  const auto above = PositionAt(frame, point.row + rows, *above_column);
  if (!beside || !above) return std::nullopt;
  const Vector3 normal = (*beside - point.position_m).cross(*above - point.position_m);
  if (!(normal.norm() > 0.0)) return std::nullopt;
  const SeenPlane plane{.middle_m = point.position_m, .normal = normal.normalized()};
  if (!IsApart(plane)) return std::nullopt;
  return plane;
}

// The plane with most points among many tries, spread evenly over the points; counted on every
// fourth point.
std::optional<SeenPlane> BestPlane(const Frame& frame,
                                   const ScanTable& scan,
                                   const std::vector<GridPoint>& points) {
  constexpr std::size_t kTries = 200;
  constexpr std::size_t kStride = 4;
  constexpr double kGolden = 0.6180339887498949;
  std::optional<SeenPlane> best;
  for (std::size_t i = 0; i < kTries; ++i) {
    const double turn = kGolden * static_cast<double>(i + 1);
    const auto place =
        static_cast<std::size_t>((turn - std::floor(turn)) * static_cast<double>(points.size()));
    auto plane = PlaneThrough(frame, scan, points[place]);
    if (!plane) continue;
    for (std::size_t k = 0; k < points.size(); k += kStride) {
      plane->num_points += IsOnPlane(*plane, points[k].position_m) ? kStride : 0;
    }
    if (!best || plane->num_points > best->num_points) best = plane;
  }
  return best;
}

bool IsInSectors(Sectors sectors, double azimuth_rad) {
  constexpr double kSector_rad = std::numbers::pi / 6.0;
  if (std::isnan(azimuth_rad)) return false;
  if (sectors == Sectors::kAll) return true;
  const auto sector = static_cast<std::int64_t>(
      std::floor((WrappedAngle_rad(azimuth_rad) + std::numbers::pi) / kSector_rad));
  return (sector % 2 == 0) == (sectors == Sectors::kEven);
}

// Gives the empty firings between two points of one plane to it, and takes short runs from it.
void CloseRuns(const Frame& frame, std::size_t row, SeenPlanes& seen) {
  constexpr std::size_t kMostEmpty = 5;
  constexpr std::size_t kLeastRun = 8;
  const auto first = seen.plane.begin() + static_cast<std::ptrdiff_t>(row * seen.scan.columns);
  const std::size_t columns = seen.scan.columns;
  for (std::size_t column = 0; column < columns;) {
    const std::uint8_t plane = first[static_cast<std::ptrdiff_t>(column)];
    if (plane == SeenPlanes::kNone) {
      ++column;
      continue;
    }
    // The run ends before the first point of something else and before long gaps.
    std::size_t last = column;
    std::size_t num_points = 1;
    for (std::size_t k = column + 1; k < columns && k - last <= kMostEmpty + 1; ++k) {
      if (first[static_cast<std::ptrdiff_t>(k)] == plane) {
        last = k;
        ++num_points;
      } else if (PositionAt(frame, row, k)) {
        break;
      }
    }
    const auto begin = first + static_cast<std::ptrdiff_t>(column);
    const auto end = first + static_cast<std::ptrdiff_t>(last + 1);
    std::fill(begin, end, num_points >= kLeastRun ? plane : SeenPlanes::kNone);
    column = last + 1;
  }
}

}  // namespace

bool SeenPlane::is_ground() const {
  const double least_up = std::cos(std::numbers::pi / 9.0);
  return std::abs(normal.z()) > least_up && middle_m.z() < 0.0;
}

PlaneCell CellOf(const SeenPlanes& seen, std::size_t plane, const Vector3& direction) {
  constexpr double kStrip_deg = 15.0;
  constexpr double kElevation_deg = 6.0;
  constexpr double kIncidence_deg = 5.0;
  const SeenPlane& met = seen.planes[plane];
  const double azimuth_rad = std::atan2(direction.y(), direction.x());
  if (met.is_ground()) {
    const auto strip = static_cast<std::size_t>((DegFromRad(azimuth_rad) + 180.0) / kStrip_deg);
    const auto bin = FineRangeBins().Find(met.RangeAlong_m(direction));
    return {plane, strip, bin.value_or(0)};
  }
  // From the sensor to the foot of the perpendicular.
  const Vector3 foot = met.normal * met.normal.dot(met.middle_m);
  const bool is_left = WrappedAngle_rad(azimuth_rad - std::atan2(foot.y(), foot.x())) > 0.0;
  const double elevation_deg = DegFromRad(std::asin(std::clamp(direction.z(), -1.0, 1.0)));
  const double cosine = std::min(1.0, std::abs(met.normal.dot(direction)));
  const auto band = static_cast<std::size_t>((elevation_deg + 90.0) / kElevation_deg);
  return {plane, 2 * band + (is_left ? 1 : 0),
          static_cast<std::size_t>(DegFromRad(std::acos(cosine)) / kIncidence_deg)};
}

SeenPlanes FindSeenPlanes(const Frame& frame, const ScanTable& scan, Sectors sectors) {
  SeenPlanes seen{.scan = scan, .planes = {}, .plane = {}};
  seen.plane.assign(std::size_t{frame.rows} * frame.columns, SeenPlanes::kNone);
  std::vector<GridPoint> points;
  for (std::size_t row = 0; row < frame.rows; ++row) {
    for (std::size_t column = 0; column < frame.columns; ++column) {
      if (!IsInSectors(sectors, scan.column_azimuth_rad[column] + scan.row_azimuth_rad[row])) {
        continue;
      }
      if (const auto position_m = PositionAt(frame, row, column)) {
        points.push_back({*position_m, row, column});
      }
    }
  }
  const auto least = static_cast<std::size_t>(kLeastShare * static_cast<double>(points.size()));
  while (seen.planes.size() < kMostPlanes && points.size() > 3) {
    auto plane = BestPlane(frame, scan, points);
    if (!plane) break;
    for (int pass = 0; pass < 4; ++pass) plane = Refitted(*plane, points);
    if (plane->num_points < std::max<std::size_t>(least, 3) || !IsApart(*plane)) break;
    const auto index = static_cast<std::uint8_t>(seen.planes.size());
    std::erase_if(points, [&](const GridPoint& point) {
      if (!IsOnPlane(*plane, point.position_m)) return false;
      seen.plane[point.row * scan.columns + point.column] = index;
      return true;
    });
    seen.planes.push_back(*plane);
  }
  for (std::size_t row = 0; row < frame.rows; ++row) CloseRuns(frame, row, seen);
  return seen;
}

}  // namespace railcast
