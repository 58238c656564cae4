#include "analysis/extras/preset/preset_comparison.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>

#include "analysis/stats/bins.h"
#include "core/base/units.h"
#include "core/points/point_spread.h"

namespace railcast {
namespace {

// The first return of a firing, in the sensor's axes; nothing if there is none or no such firing.
std::optional<Vector3> FirstPointAt(const Frame& frame, std::size_t row, std::size_t column) {
  if (row >= frame.rows || column >= frame.columns) return std::nullopt;
  const std::size_t slot = row * frame.width() + column * frame.returns;
  if (!std::isfinite(frame.range_m[slot])) return std::nullopt;
  return Vector3(static_cast<double>(frame.x[slot]), static_cast<double>(frame.y[slot]),
                 static_cast<double>(frame.z[slot]));
}

/// A firing with a point.
struct MetAt {
  std::size_t row{};
  std::size_t column{};
  Vector3 position_m = Vector3::Zero();
};

// From the point to that of another firing; nothing if it is so near that noise decides the
// direction.
std::optional<Vector3> Baseline_m(const Frame& frame,
                                  const MetAt& met,
                                  std::size_t row,
                                  std::size_t column) {
  constexpr double kLeast_m = 0.08;
  constexpr double kOfRange = 0.01;
  const auto other_m = FirstPointAt(frame, row, column);
  if (!other_m) return std::nullopt;
  const Vector3 baseline_m = *other_m - met.position_m;
  const bool is_far = baseline_m.norm() >= kLeast_m + kOfRange * met.position_m.norm();
  return is_far ? std::optional(baseline_m) : std::nullopt;
}

// From one neighbour to the other if the point is about in line with them, else nothing.
std::optional<Vector3> ThroughPoint_m(const std::optional<Vector3>& one_m,
                                      const std::optional<Vector3>& other_m) {
  constexpr double kMostCosine = -0.9;
  if (!one_m || !other_m) return std::nullopt;
  if (one_m->dot(*other_m) > kMostCosine * one_m->norm() * other_m->norm()) return std::nullopt;
  return Vector3(*other_m - *one_m);
}

std::optional<Vector3> AlongRing_m(const Frame& frame, const MetAt& met) {
  constexpr std::size_t kMostColumns = 60;
  std::optional<Vector3> before_m, after_m;
  for (std::size_t step = 1; step <= kMostColumns && !(before_m && after_m); ++step) {
    if (!before_m && step <= met.column) {
      before_m = Baseline_m(frame, met, met.row, met.column - step);
    }
    if (!after_m) after_m = Baseline_m(frame, met, met.row, met.column + step);
  }
  return ThroughPoint_m(before_m, after_m);
}

std::optional<Vector3> AcrossRings_m(const Frame& frame, const ScanTable& scan, const MetAt& met) {
  constexpr std::size_t kShareOfRows = 3;
  const std::size_t most_rows = std::max<std::size_t>(2, frame.rows / kShareOfRows);
  const auto from = [&](std::size_t row) -> std::optional<Vector3> {
    const auto column = scan.ColumnBeside(met.row, met.column, row);
    return column ? Baseline_m(frame, met, row, *column) : std::nullopt;
  };
  std::optional<Vector3> below_m, above_m;
  for (std::size_t step = 1; step <= most_rows && !(below_m && above_m); ++step) {
    if (!below_m && step <= met.row) below_m = from(met.row - step);
    if (!above_m && met.row + step < frame.rows) above_m = from(met.row + step);
  }
  return ThroughPoint_m(below_m, above_m);
}

// Unit normal, of either sign, of the surface about a firing's point: across the lines through its
// neighbours in its ring and in the rings above and below, the nearest ones that are at least
// 15 cm + 1 % of the range away. Zero where there are none, or where the point is no nearer than
// 26 deg to being in line with them, as at edges and in plants.
// @pre The firing has a point.
Vector3 LocalNormal(const Frame& frame,
                    const ScanTable& scan,
                    std::size_t row,
                    std::size_t column) {
  const MetAt met{row, column, FirstPointAt(frame, row, column).value_or(Vector3::Zero())};
  const auto along_m = AlongRing_m(frame, met);
  const auto across_m = AcrossRings_m(frame, scan, met);
  if (!along_m || !across_m) return Vector3::Zero();
  const Vector3 normal = along_m->cross(*across_m);
  return normal.norm() > 0.0 ? Vector3(normal.normalized()) : Vector3::Zero();
}

constexpr std::size_t kMostPlanes = 24;
constexpr double kLeastShare = 0.004;

struct GridPoint {
  Vector3 position_m = Vector3::Zero();
  Vector3 normal = Vector3::Zero();  // Normal of the surface about it; zero if that is not known.
  std::size_t row{};
  std::size_t column{};
};

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

// Whether the surface about the point lies as the plane does. Level planes through hedges and walls
// hold many points, too, but not their surfaces.
bool LiesAlong(const SeenPlane& plane, const GridPoint& point) {
  constexpr double kLeastCosine = 0.9;  // 26 deg.
  return std::abs(plane.normal.dot(point.normal)) >= kLeastCosine;
}

bool IsOf(const SeenPlane& plane, const GridPoint& point) {
  return LiesAlong(plane, point) && IsOnPlane(plane, point.position_m);
}

// Least squares through the points on the plane.
SeenPlane Refitted(const SeenPlane& plane, const std::vector<GridPoint>& points) {
  std::vector<Eigen::Vector3f> places_m;
  for (const GridPoint& point : points) {
    if (IsOf(plane, point)) places_m.emplace_back(point.position_m.cast<float>());
  }
  if (places_m.size() < 3) return plane;
  const PointSpread spread = SpreadOf(places_m);
  return {.middle_m = spread.mean_m, .normal = spread.axes.col(0), .num_points = places_m.size()};
}

// The plane with most points among many tries, those through the surfaces about points that are
// spread evenly; counted on every fourth point.
std::optional<SeenPlane> BestPlane(const std::vector<GridPoint>& points) {
  constexpr std::size_t kTries = 200;
  constexpr std::size_t kStride = 4;
  constexpr double kGolden = 0.6180339887498949;
  std::optional<SeenPlane> best;
  for (std::size_t i = 0; i < kTries; ++i) {
    const double turn = kGolden * static_cast<double>(i + 1);
    const auto place =
        static_cast<std::size_t>((turn - std::floor(turn)) * static_cast<double>(points.size()));
    SeenPlane plane{.middle_m = points[place].position_m, .normal = points[place].normal};
    if (!IsApart(plane)) continue;
    for (std::size_t k = 0; k < points.size(); k += kStride) {
      plane.num_points += IsOf(plane, points[k]) ? kStride : 0;
    }
    if (!best || plane.num_points > best->num_points) best = plane;
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

// Gives the empty firings between two points of one plane to it. Takes runs from it that are short,
// or that most of the surface about which lies otherwise.
// @param lies_along Of the frame's firings: whether the surface about its point lies as the plane.
void CloseRuns(const Frame& frame,
               std::size_t row,
               const std::vector<bool>& lies_along,
               SeenPlanes& seen) {
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
    std::size_t num_along = lies_along[row * columns + column] ? 1 : 0;
    for (std::size_t k = column + 1; k < columns && k - last <= kMostEmpty + 1; ++k) {
      if (first[static_cast<std::ptrdiff_t>(k)] == plane) {
        last = k;
        ++num_points;
        num_along += lies_along[row * columns + k] ? 1 : 0;
      } else if (FirstPointAt(frame, row, k)) {
        break;
      }
    }
    const auto begin = first + static_cast<std::ptrdiff_t>(column);
    const auto end = first + static_cast<std::ptrdiff_t>(last + 1);
    const bool is_kept = num_points >= kLeastRun && 2 * num_along >= num_points;
    std::fill(begin, end, is_kept ? plane : SeenPlanes::kNone);
    column = last + 1;
  }
}

}  // namespace

bool SeenPlane::is_ground() const {
  const double least_up = std::cos(std::numbers::pi / 9.0);
  return std::abs(normal.z()) > least_up && middle_m.z() < 0.0;
}

PlaneCell CellOf(const SeenPlanes& seen, std::size_t plane, const Vector3& direction) {
  constexpr double kStrip_deg = 5.0;
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
  std::vector<GridPoint> smooth;  // The points about which the surface is known.
  for (std::size_t row = 0; row < frame.rows; ++row) {
    for (std::size_t column = 0; column < frame.columns; ++column) {
      if (!IsInSectors(sectors, scan.column_azimuth_rad[column] + scan.row_azimuth_rad[row])) {
        continue;
      }
      if (const auto position_m = FirstPointAt(frame, row, column)) {
        points.push_back({*position_m, LocalNormal(frame, scan, row, column), row, column});
        if (!points.back().normal.isZero()) smooth.push_back(points.back());
      }
    }
  }
  const auto least = static_cast<std::size_t>(kLeastShare * static_cast<double>(points.size()));
  std::vector<bool> lies_along(seen.plane.size(), false);
  while (seen.planes.size() < kMostPlanes && smooth.size() > 3) {
    const auto best = BestPlane(smooth);
    if (!best) break;
    SeenPlane plane = *best;
    for (int pass = 0; pass < 4; ++pass) plane = Refitted(plane, smooth);
    if (plane.num_points < std::max<std::size_t>(least, 3)) break;
    const auto index = static_cast<std::uint8_t>(seen.planes.size());
    const bool is_apart = IsApart(plane);
    const std::size_t num_taken = std::erase_if(smooth, [&](const GridPoint& point) {
      if (!IsOf(plane, point)) return false;
      const std::size_t place = point.row * scan.columns + point.column;
      if (is_apart) seen.plane[place] = index;
      lies_along[place] = is_apart;
      return true;
    });
    // The fits may have turned the plane away from all points; it would be the best one again.
    if (num_taken == 0) {
      std::erase_if(smooth, [&](const GridPoint& point) { return IsOf(*best, point); });
      continue;
    }
    if (!is_apart) continue;
    // Points with too few neighbours for a surface of their own go with those of their run.
    for (const GridPoint& point : points) {
      std::uint8_t& its = seen.plane[point.row * scan.columns + point.column];
      if (its == SeenPlanes::kNone && IsOnPlane(plane, point.position_m)) its = index;
    }
    seen.planes.push_back(plane);
  }
  for (std::size_t row = 0; row < frame.rows; ++row) CloseRuns(frame, row, lies_along, seen);
  return seen;
}

}  // namespace railcast
