#include "core/io/recording/slot_plans.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>
#include <utility>

#include "core/base/error.h"
#include "core/base/text.h"
#include "core/io/recording/ring_table.h"

namespace railcast {
namespace {

constexpr std::uint32_t kMaxReturns = 3;
constexpr std::uint32_t kMaxRows = 1U << 16U;

/// Where the rows and columns of a scan are in the table of its cloud.
struct StoredGrid {
  std::uint32_t rows{};
  std::uint32_t columns{};
  bool is_transposed{};

  [[nodiscard]] std::size_t Entry(std::uint32_t row, std::uint32_t column) const {
    return is_transposed ? std::size_t{column} * rows + row : std::size_t{row} * columns + column;
  }
};

/// Whether all points of a line have the same ring, for each line of the table.
bool HasRingForEach(const StoredGrid& lines,
                    const PointPositions& positions,
                    const std::vector<double>& rings) {
  for (std::uint32_t line = 0; line < lines.rows; ++line) {
    std::optional<double> ring;
    for (std::uint32_t place = 0; place < lines.columns; ++place) {
      const std::size_t entry = lines.Entry(line, place);
      if (!positions.IsPoint(entry)) continue;
      if (ring && *ring != rings[entry]) return false;
      ring = rings[entry];
    }
  }
  return true;
}

/// The elevation of a point, in rad.
double ElevationOf(const PointPositions& positions, std::size_t i) {
  return static_cast<double>(
      std::atan2(positions.z[i], std::hypot(positions.x[i], positions.y[i])));
}

/// The variance of elevations within the rows of a grid, in rad^2.
double VarianceInRows(const StoredGrid& grid, const PointPositions& positions) {
  double sum = 0.0;
  std::size_t num_more = 0;
  for (std::uint32_t row = 0; row < grid.rows; ++row) {
    double mean_rad = 0.0;
    std::size_t num = 0;
    for (std::uint32_t column = 0; column < grid.columns; ++column) {
      const std::size_t i = grid.Entry(row, column);
      if (!positions.IsPoint(i)) continue;
      const double off_rad = ElevationOf(positions, i) - mean_rad;
      mean_rad += off_rad / static_cast<double>(++num);
      sum += off_rad * (ElevationOf(positions, i) - mean_rad);
    }
    num_more += num > 0 ? num - 1 : 0;
  }
  return num_more > 0 ? sum / static_cast<double>(num_more) : 0.0;
}

/// The grid whose rows are rings: its points say so or, without rings, their elevations, which are
/// nearly the same along a ring. Drivers may store a row for each firing.
StoredGrid FindGrid(const Cloud& cloud, const PointPositions& positions, const CloudField* ring) {
  const StoredGrid by_rows{cloud.height, cloud.width, false};
  const StoredGrid by_columns{cloud.width, cloud.height, true};
  // Lasers are fewer than firings.
  if (ring == nullptr && by_columns.rows >= by_rows.rows) return by_rows;
  if (ring == nullptr) {
    constexpr double kClear = 16.0;  // A quarter of the standard deviation.
    const double along_columns = VarianceInRows(by_columns, positions);
    return kClear * along_columns < VarianceInRows(by_rows, positions) ? by_columns : by_rows;
  }
  std::vector<double> rings(cloud.num_points());
  VisitField(cloud, *ring,
             [&](std::size_t i, auto value) { rings[i] = static_cast<double>(value); });
  if (HasRingForEach(by_rows, positions, rings)) return by_rows;
  return HasRingForEach(by_columns, positions, rings) ? by_columns : by_rows;
}

/// Returns the mean elevation of each row; NaN for a row without a point.
std::vector<double> RowElevations(const StoredGrid& grid, const PointPositions& positions) {
  std::vector<double> elevations_rad;
  for (std::uint32_t row = 0; row < grid.rows; ++row) {
    double sum_rad = 0.0;
    std::size_t num = 0;
    for (std::uint32_t column = 0; column < grid.columns; ++column) {
      const std::size_t i = grid.Entry(row, column);
      if (!positions.IsPoint(i)) continue;
      sum_rad += ElevationOf(positions, i);
      ++num;
    }
    elevations_rad.push_back(num > 0 ? sum_rad / static_cast<double>(num) : std::nan(""));
  }
  return elevations_rad;
}

/// Returns the rows as stored, or in reverse order if most elevations fall.
std::vector<std::uint32_t> RowsInSense(const std::vector<double>& elevations_rad) {
  std::vector<std::uint32_t> rows(elevations_rad.size());
  std::iota(rows.begin(), rows.end(), 0U);
  std::int64_t balance = 0;
  double last_rad = std::nan("");
  for (const double elevation_rad : elevations_rad) {
    if (elevation_rad > last_rad) ++balance;
    if (elevation_rad < last_rad) --balance;
    if (!std::isnan(elevation_rad)) last_rad = elevation_rad;
  }
  if (balance < 0) std::ranges::reverse(rows);
  return rows;
}

/// Turns positions so that the rows of their grid become level, if they are not and if that is
/// possible, as those of a sensor that lies on its side.
/// @returns SlotPlan::sensor_from_spin.
std::optional<Eigen::Matrix3d> LevelRows(const Cloud& cloud,
                                         const CloudField* ring,
                                         PointPositions& positions,
                                         StoredGrid& grid) {
  constexpr double kLevel_rad = std::numbers::pi / 180.0;
  constexpr double kClear = 16.0;  // A quarter of the standard deviation.
  const double variance = VarianceInRows(grid, positions);
  if (variance < kLevel_rad * kLevel_rad) return std::nullopt;
  const auto sensor_from_spin = FindSpinAxis(positions);
  if (!sensor_from_spin) return std::nullopt;
  PointPositions turned = InSpinAxes(positions, *sensor_from_spin);
  const StoredGrid again = FindGrid(cloud, turned, ring);
  if (kClear * VarianceInRows(again, turned) > variance) return std::nullopt;
  positions = std::move(turned);
  grid = again;
  return sensor_from_spin;
}

std::uint32_t LargestOf(const std::vector<std::uint32_t>& values) {
  return values.empty() ? 0 : *std::ranges::max_element(values);
}

ScanShape ShapeOf(const std::vector<std::uint32_t>& rings,
                  const std::vector<std::uint32_t>& columns,
                  std::uint32_t returns,
                  const std::string& name) {
  if (rings.empty()) return {};
  const std::uint64_t num_rows = std::uint64_t{LargestOf(rings)} + 1;
  const std::uint64_t num_columns = std::uint64_t{LargestOf(columns)} + 1;
  if (num_rows * num_columns * returns > kMaxSpareSlots + rings.size()) {
    throw InputError(name + ": ring, column: must make no more than " +
                     NumberText(kMaxSpareSlots + rings.size()) + " slots (got " +
                     NumberText(num_rows) + " x " + NumberText(num_columns) + " x " +
                     NumberText(returns) + ")");
  }
  return {static_cast<std::uint32_t>(num_rows), static_cast<std::uint32_t>(num_columns)};
}

std::vector<float> LoadFloats(const Cloud& cloud, std::string_view name) {
  std::vector<float> values(cloud.num_points());
  VisitField(cloud, *FindFieldOf(cloud, name),
             [&](std::size_t i, auto value) { values[i] = static_cast<float>(value); });
  return values;
}

}  // namespace

PointPositions LoadPositions(const Cloud& cloud) {
  return {LoadFloats(cloud, "x"), LoadFloats(cloud, "y"), LoadFloats(cloud, "z")};
}

SlotPlan OrganisedPlan(const Cloud& cloud, std::uint32_t returns) {
  return {.rows = cloud.height,
          .columns = cloud.width / returns,
          .returns = returns,
          .slots = {},
          .is_grid = true};
}

SlotPlan SortedRowsPlan(const Cloud& cloud, const CloudField* ring) {
  PointPositions positions = LoadPositions(cloud);
  StoredGrid grid = FindGrid(cloud, positions, ring);
  if (grid.rows > kMaxRows) return LoosePlan(cloud, "it has more than 65536 rows");
  const auto sensor_from_spin = LevelRows(cloud, ring, positions, grid);
  SlotPlan plan{.rows = grid.rows,
                .columns = grid.columns,
                .returns = 1,
                .slots = {},
                .is_grid = true,
                .sensor_from_spin = sensor_from_spin};
  const std::vector<double> elevations_rad = RowElevations(grid, positions);
  const std::vector<std::uint32_t> stored = RowsInSense(elevations_rad);
  std::vector<std::pair<double, std::uint32_t>> order;
  double last_rad = -std::numeric_limits<double>::infinity();
  for (const std::uint32_t row : stored) {
    if (!std::isnan(elevations_rad[row])) last_rad = elevations_rad[row];
    order.emplace_back(last_rad, row);
  }
  std::ranges::stable_sort(order, {}, &std::pair<double, std::uint32_t>::first);
  plan.slots.resize(cloud.num_points());
  for (std::uint32_t row = 0; row < grid.rows; ++row) {
    for (std::uint32_t column = 0; column < grid.columns; ++column) {
      plan.slots[grid.Entry(order[row].second, column)] = row * grid.columns + column;
    }
  }
  return plan;
}

SlotPlan PlacedPlan(const Cloud& cloud,
                    const std::string& name,
                    const std::optional<ScanShape>& shape) {
  const std::uint32_t most_rows = shape ? shape->rows : kMaxRows;
  const std::uint32_t most_columns = shape ? shape->columns : kNoSlot;
  const auto rings = LoadIndices(cloud, NeedFieldOf(cloud, "ring", name), most_rows - 1, name);
  const auto columns =
      LoadIndices(cloud, NeedFieldOf(cloud, "column", name), most_columns - 1, name);
  const CloudField* const return_index = cloud.Find("return_index");
  const auto returns = return_index != nullptr
                           ? LoadIndices(cloud, *return_index, kMaxReturns - 1, name)
                           : std::vector<std::uint32_t>(cloud.num_points(), 0);
  SlotPlan plan{.returns = LargestOf(returns) + 1, .slots = {}, .is_grid = true};
  const ScanShape found = shape ? *shape : ShapeOf(rings, columns, plan.returns, name);
  plan.rows = found.rows;
  plan.columns = found.columns;
  std::vector<bool> is_taken(std::size_t{plan.rows} * plan.columns * plan.returns);
  for (std::size_t i = 0; i < cloud.num_points(); ++i) {
    const std::uint32_t slot = (rings[i] * plan.columns + columns[i]) * plan.returns + returns[i];
    if (is_taken[slot]) {
      throw InputError(name + ": point " + NumberText(i) +
                       ": must be the only one of its ring, column and return_index (got " +
                       NumberText(rings[i]) + ", " + NumberText(columns[i]) + ", " +
                       NumberText(returns[i]) + ")");
    }
    is_taken[slot] = true;
    plan.slots.push_back(slot);
  }
  return plan;
}

SlotPlan LoosePlan(const Cloud& cloud, const std::string& why_no_grid) {
  const PointPositions positions = LoadPositions(cloud);
  SlotPlan plan{.rows = 1, .returns = 1, .slots = {}, .why_no_grid = why_no_grid};
  for (std::size_t i = 0; i < positions.size(); ++i) {
    plan.slots.push_back(positions.IsPoint(i) ? plan.columns++ : kNoSlot);
  }
  return plan;
}

}  // namespace railcast
