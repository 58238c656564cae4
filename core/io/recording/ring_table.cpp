#include "core/io/recording/ring_table.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <numbers>
#include <numeric>
#include <tuple>
#include <utility>

#include "core/base/median.h"
#include "core/base/text.h"
#include "core/io/recording/elevation_rings.h"

namespace railcast {
namespace {

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
/// @returns Whether no gap is.
bool StartBehindGap(std::vector<TablePoint>& points, double first) {
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
  return widest < kMinGap_turns;
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
  std::vector<LevelPoint> level;
};

RingCloud GatherPoints(const PointPositions& positions, std::span<const std::uint32_t> rings) {
  RingCloud cloud;
  for (std::size_t i = 0; i < positions.size(); ++i) {
    if (!positions.IsPoint(i)) continue;
    const auto x = static_cast<double>(positions.x[i]);
    const auto y = static_cast<double>(positions.y[i]);
    const auto z = static_cast<double>(positions.z[i]);
    const double horizontal_m = std::hypot(x, y);
    cloud.level.push_back({horizontal_m, z});
    if (!rings.empty()) cloud.rings.push_back(rings[i]);
    cloud.points.push_back({.index = static_cast<std::uint32_t>(i),
                            .turns = WrappedTurns(std::atan2(y, x) / (2.0 * std::numbers::pi)),
                            .range_m = std::hypot(horizontal_m, z),
                            .from_axis_m = horizontal_m});
  }
  return cloud;
}

/// Numbers the rows by rising median elevation from ring numbers of any kind.
std::vector<std::uint32_t> RowsOf(const RingCloud& cloud) {
  std::map<std::uint32_t, std::vector<double>> by_ring;
  for (std::size_t i = 0; i < cloud.rings.size(); ++i) {
    by_ring[cloud.rings[i]].push_back(cloud.level[i].ElevationFrom_rad({}));
  }
  std::vector<std::pair<double, std::uint32_t>> order;
  for (auto& [ring, values] : by_ring) {
    order.emplace_back(MedianOf(values), ring);
  }
  std::ranges::sort(order);
  std::map<std::uint32_t, std::uint32_t> row_of_ring;
  for (const auto& [elevation_rad, ring] : order) {
    row_of_ring.emplace(ring, static_cast<std::uint32_t>(row_of_ring.size()));
  }
  std::vector<std::uint32_t> rows;
  rows.reserve(cloud.rings.size());
  for (const std::uint32_t ring : cloud.rings) rows.push_back(row_of_ring.at(ring));
  return rows;
}

/// MakeRingTable() of a sensor that spins about z.
std::optional<SlotPlan> TableAboutZ(const PointPositions& positions,
                                    std::span<const std::uint32_t> rings,
                                    std::string* why_not) {
  const auto refuse = [&](const std::string& why) -> std::optional<SlotPlan> {
    if (why_not != nullptr) *why_not = why;
    return std::nullopt;
  };
  RingCloud cloud = GatherPoints(positions, rings);
  std::vector<TablePoint>& points = cloud.points;
  if (points.empty()) return refuse("it has no points");
  double outwards_m = 0.0;
  if (rings.empty()) {
    auto found = FindRings(cloud.level);
    if (!found) return refuse("it has no field ring, and its elevations do not form rings");
    cloud.rings = std::move(found->rings);
    outwards_m = found->origin_m[0];
  }
  const std::vector<std::uint32_t> rows = rings.empty() ? cloud.rings : RowsOf(cloud);
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
  if (outwards_m > 0.0) {
    RemoveParallax(points, steps, outwards_m);
    for (TablePoint& point : points) point.turns = WrappedTurns(point.turns);
  }
  const double shortest = steps.column / *std::ranges::max_element(steps.firings);
  const bool is_full_turn = StartBehindGap(points, WrappedTurns(first - 0.5 * shortest));
  SortByRow(points);
  AssignColumns(points, steps);
  if (!AreFiringsCertain(points, steps)) {
    return refuse(
        "the azimuths of its rings have no common step, as where several sensors are mixed, the "
        "sensor's motion is undone or points were thinned out");
  }
  // A rotor of which the columns are known but for parallax is even.
  if (shortest == steps.column && outwards_m <= 0.0) {
    AlignCycles(points, steps.column, is_full_turn);
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

}  // namespace

bool PointPositions::IsPoint(std::size_t i) const {
  const float squared = x[i] * x[i] + y[i] * y[i] + z[i] * z[i];
  return std::isfinite(squared) && squared > 0.0F;
}

PointPositions InSpinAxes(PointPositions positions, const Eigen::Matrix3d& sensor_from_spin) {
  const Eigen::Matrix3d spin_from_sensor = sensor_from_spin.transpose();
  for (std::size_t i = 0; i < positions.size(); ++i) {
    const Eigen::Vector3f turned_m =
        (spin_from_sensor * Vector3(positions.x[i], positions.y[i], positions.z[i])).cast<float>();
    positions.x[i] = turned_m.x();
    positions.y[i] = turned_m.y();
    positions.z[i] = turned_m.z();
  }
  return positions;
}

std::optional<SlotPlan> MakeRingTable(const PointPositions& positions,
                                      std::span<const std::uint32_t> rings,
                                      std::string* why_not) {
  if (auto plan = TableAboutZ(positions, rings, why_not)) return plan;
  const auto sensor_from_spin = FindSpinAxis(positions);
  if (!sensor_from_spin) return std::nullopt;
  auto plan = TableAboutZ(InSpinAxes(positions, *sensor_from_spin), rings, nullptr);
  if (plan) plan->sensor_from_spin = sensor_from_spin;
  return plan;
}

}  // namespace railcast
