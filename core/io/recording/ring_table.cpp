#include "core/io/recording/ring_table.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <numbers>
#include <numeric>
#include <tuple>
#include <utility>

#include "core/base/text.h"
#include "core/base/units.h"

namespace railcast {
namespace {

constexpr double kMinShare = 0.98;
constexpr std::size_t kMinClusterPoints = 8;
/// Clusters with a smaller share of all points than this are strays.
constexpr double kMinClusterShare = 1e-3;

struct Cluster {
  double low_rad{};
  double high_rad{};
  std::size_t num_points{};

  [[nodiscard]] double middle_rad() const { return 0.5 * (low_rad + high_rad); }
};

/// Splits the elevations at gaps wider than `gap_rad` and drops the clusters of strays.
std::vector<Cluster> ClustersOf(std::span<const double> sorted_rad, double gap_rad) {
  const auto min_points =
      std::max(kMinClusterPoints,
               static_cast<std::size_t>(kMinClusterShare * static_cast<double>(sorted_rad.size())));
  std::vector<Cluster> clusters;
  std::size_t begin = 0;
  for (std::size_t i = 1; i <= sorted_rad.size(); ++i) {
    if (i < sorted_rad.size() && sorted_rad[i] - sorted_rad[i - 1] <= gap_rad) continue;
    if (i - begin >= min_points)
      clusters.push_back({sorted_rad[begin], sorted_rad[i - 1], i - begin});
    begin = i;
  }
  return clusters;
}

bool AreRings(const std::vector<Cluster>& clusters, std::size_t num_points) {
  if (clusters.size() < 2 || clusters.size() > kMaxRings) return false;
  std::size_t num_inside = 0;
  for (std::size_t i = 0; i < clusters.size(); ++i) {
    const Cluster& cluster = clusters[i];
    num_inside += cluster.num_points;
    const double width_rad = cluster.high_rad - cluster.low_rad;
    const auto is_near = [&](const Cluster& other) {
      return width_rad > 0.5 * std::abs(other.middle_rad() - cluster.middle_rad());
    };
    if (i > 0 && is_near(clusters[i - 1])) return false;
    if (i + 1 < clusters.size() && is_near(clusters[i + 1])) return false;
  }
  return static_cast<double>(num_inside) >= kMinShare * static_cast<double>(num_points);
}

std::uint32_t NearestOf(const std::vector<Cluster>& clusters, double elevation_rad) {
  const auto above = std::ranges::lower_bound(clusters, elevation_rad, {}, &Cluster::high_rad);
  if (above == clusters.begin()) return 0;
  const auto index = static_cast<std::uint32_t>(above - clusters.begin());
  if (above == clusters.end()) return index - 1;
  const Cluster& below = *(above - 1);
  return elevation_rad - below.high_rad < above->low_rad - elevation_rad ? index - 1 : index;
}

/// Neighbours of a ring farther apart than this, in turns, say nothing about the sense of rotation.
constexpr double kMaxFollow_turns = 0.02;
/// A turn without a gap wider than this is a full one.
constexpr double kMinGap_turns = 0.03;
/// A cell with more points than this does not hold the returns of one firing, so there is no table.
constexpr std::uint32_t kMaxRingReturns = 4;
/// A table with more slots per point than this is nearly empty and is not used.
constexpr std::size_t kMaxSlotsPerPoint = 16;

double WrappedTurns(double turns) {
  const double wrapped = turns - std::floor(turns);
  return wrapped < 1.0 ? wrapped : 0.0;  // A tiny negative number rounds to 1.
}

/// Numbers the rows by rising median elevation from ring numbers of any kind.
std::vector<std::uint32_t> RowsOf(std::span<const std::uint32_t> rings,
                                  std::span<const double> elevations_rad) {
  std::map<std::uint32_t, std::vector<double>> by_ring;
  for (std::size_t i = 0; i < rings.size(); ++i) by_ring[rings[i]].push_back(elevations_rad[i]);
  std::vector<std::pair<double, std::uint32_t>> order;
  for (auto& [ring, values] : by_ring) {
    const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
    std::ranges::nth_element(values, middle);
    order.emplace_back(*middle, ring);
  }
  std::ranges::sort(order);
  std::map<std::uint32_t, std::uint32_t> row_of_ring;
  for (const auto& [elevation_rad, ring] : order) {
    row_of_ring.emplace(ring, static_cast<std::uint32_t>(row_of_ring.size()));
  }
  std::vector<std::uint32_t> rows;
  rows.reserve(rings.size());
  for (const std::uint32_t ring : rings) rows.push_back(row_of_ring.at(ring));
  return rows;
}

void SortByRow(std::vector<TablePoint>& points) {
  std::ranges::stable_sort(
      points, {}, [](const TablePoint& point) { return std::pair(point.row, point.turns); });
}

/// Whether most neighbours of a row follow each other counterclockwise.
/// @pre The points are in the file's order, with azimuths counterclockwise.
bool IsCounterclockwise(const std::vector<TablePoint>& points, std::size_t num_rows) {
  constexpr double kNone = -1.0;
  std::vector<double> last_turns(num_rows, kNone);
  std::int64_t balance = 0;
  for (const TablePoint& point : points) {
    double& last = last_turns[point.row];
    if (last != kNone) {
      const double step = std::remainder(point.turns - last, 1.0);
      if (std::abs(step) < kMaxFollow_turns && step != 0.0) balance += step > 0.0 ? 1 : -1;
    }
    last = point.turns;
  }
  return balance > 0;
}

/// Shifts the azimuths so that 0 lies behind the widest gap, or at `first` if no gap is wide.
void StartBehindGap(std::vector<TablePoint>& points, double first) {
  std::vector<double> sorted;
  sorted.reserve(points.size());
  for (const TablePoint& point : points) sorted.push_back(point.turns);
  std::ranges::sort(sorted);
  double widest = sorted.front() + 1.0 - sorted.back();
  double start = sorted.front();
  for (std::size_t i = 1; i < sorted.size(); ++i) {
    if (sorted[i] - sorted[i - 1] <= widest) continue;
    widest = sorted[i] - sorted[i - 1];
    start = sorted[i];
  }
  if (widest < kMinGap_turns) start = first;
  for (TablePoint& point : points) point.turns = WrappedTurns(point.turns - start);
}

/// Makes as many rows of each row as it has firings within a column, and counts columns in steps
/// that all rows share.
/// @returns The number of rows.
std::uint32_t SplitRows(const AzimuthSteps& steps, std::vector<TablePoint>& points) {
  std::vector<std::uint32_t> first_row;
  std::uint32_t num_rows = 0;
  for (const std::uint32_t firings : steps.firings) {
    first_row.push_back(num_rows);
    num_rows += firings;
  }
  for (TablePoint& point : points) {
    const std::int64_t firings = steps.firings[point.row];
    const std::int64_t within = ((point.column % firings) + firings) % firings;
    point.column = (point.column - within) / firings;
    point.row = first_row[point.row] + static_cast<std::uint32_t>(within);
  }
  return num_rows;
}

/// Renumbers the columns that have a point from 0.
/// @returns The number of columns.
std::uint32_t CloseColumns(std::vector<TablePoint>& points) {
  std::vector<std::int64_t> seen;
  seen.reserve(points.size());
  for (const TablePoint& point : points) seen.push_back(point.column);
  std::ranges::sort(seen);
  seen.erase(std::unique(seen.begin(), seen.end()), seen.end());
  for (TablePoint& point : points) {
    point.column = std::ranges::lower_bound(seen, point.column) - seen.begin();
  }
  return static_cast<std::uint32_t>(seen.size());
}

bool IsSameCell(const TablePoint& a, const TablePoint& b) {
  return a.row == b.row && a.column == b.column;
}

/// Returns the largest number of points in one cell.
/// @pre Sorted by cell.
std::uint32_t MostInACell(const std::vector<TablePoint>& points) {
  std::uint32_t most = 1;
  std::uint32_t in_cell = 1;
  for (std::size_t i = 1; i < points.size(); ++i) {
    in_cell = IsSameCell(points[i - 1], points[i]) ? in_cell + 1 : 1;
    most = std::max(most, in_cell);
  }
  return most;
}

/// Gives each point its slot; points of one cell follow from the nearest on.
/// @pre Sorted by cell and range.
SlotPlan PlanOf(const std::vector<TablePoint>& points,
                std::uint32_t rows,
                std::uint32_t columns,
                std::size_t num_file_points) {
  SlotPlan plan{.rows = rows,
                .columns = columns,
                .returns = MostInACell(points),
                .slots = std::vector(num_file_points, kNoSlot),
                .is_grid = true};
  std::uint32_t in_cell = 0;
  for (std::size_t i = 0; i < points.size(); ++i) {
    in_cell = i > 0 && IsSameCell(points[i - 1], points[i]) ? in_cell + 1 : 0;
    const auto column = static_cast<std::uint32_t>(points[i].column);
    plan.slots[points[i].index] = (points[i].row * columns + column) * plan.returns + in_cell;
  }
  return plan;
}

/// The points of a cloud with the ring and the elevation of each.
struct RingCloud {
  std::vector<TablePoint> points;
  std::vector<std::uint32_t> rings;
  std::vector<double> elevations_rad;
};

RingCloud GatherPoints(const PointPositions& positions, std::span<const std::uint32_t> rings) {
  RingCloud cloud;
  for (std::size_t i = 0; i < positions.size(); ++i) {
    if (!positions.IsPoint(i)) continue;
    const auto x = static_cast<double>(positions.x[i]);
    const auto y = static_cast<double>(positions.y[i]);
    const auto z = static_cast<double>(positions.z[i]);
    const double horizontal_m = std::hypot(x, y);
    cloud.elevations_rad.push_back(std::atan2(z, horizontal_m));
    if (!rings.empty()) cloud.rings.push_back(rings[i]);
    cloud.points.push_back({.index = static_cast<std::uint32_t>(i),
                            .turns = WrappedTurns(std::atan2(y, x) / (2.0 * std::numbers::pi)),
                            .range_m = std::hypot(horizontal_m, z)});
  }
  return cloud;
}

}  // namespace

std::optional<std::vector<std::uint32_t>> RingsByElevation(std::span<const double> elevations_rad) {
  std::vector<double> sorted_rad(elevations_rad.begin(), elevations_rad.end());
  std::ranges::sort(sorted_rad);
  // The gaps range from the float32 rounding of exact elevations to that of millimetres at 1 m.
  for (const double gap_deg : {0.005, 0.02, 0.05, 0.1}) {
    const std::vector<Cluster> clusters = ClustersOf(sorted_rad, RadFromDeg(gap_deg));
    if (!AreRings(clusters, sorted_rad.size())) continue;
    std::vector<std::uint32_t> rings;
    rings.reserve(elevations_rad.size());
    for (const double elevation_rad : elevations_rad) {
      rings.push_back(NearestOf(clusters, elevation_rad));
    }
    return rings;
  }
  return std::nullopt;
}

bool PointPositions::IsPoint(std::size_t i) const {
  const float squared = x[i] * x[i] + y[i] * y[i] + z[i] * z[i];
  return std::isfinite(squared) && squared > 0.0F;
}

std::optional<SlotPlan> MakeRingTable(const PointPositions& positions,
                                      std::span<const std::uint32_t> rings,
                                      std::string* why_not) {
  const auto refuse = [&](const std::string& why) -> std::optional<SlotPlan> {
    if (why_not != nullptr) *why_not = why;
    return std::nullopt;
  };
  RingCloud cloud = GatherPoints(positions, rings);
  std::vector<TablePoint>& points = cloud.points;
  if (points.empty()) return refuse("it has no points");
  if (rings.empty()) {
    auto found = RingsByElevation(cloud.elevations_rad);
    if (!found) return refuse("it has no field ring, and its elevations do not form rings");
    cloud.rings = std::move(*found);
  }
  const std::vector<std::uint32_t> rows = RowsOf(cloud.rings, cloud.elevations_rad);
  const std::uint32_t num_rings = *std::ranges::max_element(rows) + 1;
  if (num_rings > kMaxRings) {
    return refuse("its points have " + NumberText(num_rings) + " rings, more than " +
                  NumberText(kMaxRings));
  }
  for (std::size_t i = 0; i < points.size(); ++i) points[i].row = rows[i];
  if (!IsCounterclockwise(points, num_rings)) {
    for (TablePoint& point : points) point.turns = WrappedTurns(-point.turns);
  }
  const double first = points.front().turns;
  SortByRow(points);
  const AzimuthSteps steps = AzimuthStepsOf(points, num_rings);
  if (steps.column <= 0.0) return refuse("no ring has two points beside each other");
  const double shortest = steps.column / *std::ranges::max_element(steps.firings);
  StartBehindGap(points, WrappedTurns(first - 0.5 * shortest));
  SortByRow(points);
  AssignColumns(points, steps);
  if (!AreFiringsCertain(points, steps)) {
    return refuse(
        "the azimuths of its rings have no common step, as where several sensors are mixed, the "
        "sensor's motion is undone or points were thinned out");
  }
  const std::uint32_t num_rows = SplitRows(steps, points);
  const std::uint32_t num_columns = CloseColumns(points);
  if (std::size_t{num_rows} * num_columns > kMaxSlotsPerPoint * points.size()) {
    return refuse("its " + NumberText(points.size()) + " points are too few for " +
                  NumberText(num_rows) + " rings of " + NumberText(num_columns) + " azimuths");
  }
  std::ranges::stable_sort(points, {}, [](const TablePoint& point) {
    return std::tuple(point.row, point.column, point.range_m);
  });
  if (MostInACell(points) > kMaxRingReturns) {
    return refuse("up to " + NumberText(MostInACell(points)) +
                  " points of a ring have one azimuth, more than " + NumberText(kMaxRingReturns));
  }
  return PlanOf(points, num_rows, num_columns, positions.size());
}

}  // namespace railcast
