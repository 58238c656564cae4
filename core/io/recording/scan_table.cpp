#include "core/io/recording/scan_table.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "core/base/median.h"

namespace railcast {
namespace {

constexpr double kUnknown = std::numeric_limits<double>::quiet_NaN();

// Interpolates linearly between known values; unknown values at the ends stay unknown.
void FillGaps(std::vector<double>& values) {
  std::size_t known = values.size();
  for (std::size_t i = 0; i < values.size(); ++i) {
    if (std::isnan(values[i])) continue;
    for (std::size_t k = known + 1; known < values.size() && k < i; ++k) {
      const double share = static_cast<double>(k - known) / static_cast<double>(i - known);
      values[k] = values[known] + share * (values[i] - values[known]);
    }
    known = i;
  }
}

/// The directions of a grid's firings; NaN where a firing has none.
struct DirectionGrid {
  DirectionGrid(std::uint32_t num_rows, std::uint32_t num_columns)
      : rows(num_rows),
        columns(num_columns),
        azimuth_rad(std::size_t{rows} * columns, kUnknown),
        elevation_rad(azimuth_rad) {}

  void Set(std::size_t place, double x, double y, double z) {
    azimuth_rad[place] = std::atan2(y, x);
    elevation_rad[place] = std::atan2(z, std::hypot(x, y));
  }

  std::uint32_t rows, columns;
  std::vector<double> azimuth_rad, elevation_rad;
};

void FindElevations(const DirectionGrid& grid, ScanTable& table) {
  table.elevation_rad.resize(grid.rows);
  std::vector<double> values;
  for (std::size_t row = 0; row < grid.rows; ++row) {
    values.clear();
    for (std::size_t column = 0; column < grid.columns; ++column) {
      const double elevation_rad = grid.elevation_rad[row * grid.columns + column];
      if (!std::isnan(elevation_rad)) values.push_back(elevation_rad);
    }
    table.elevation_rad[row] = MedianOf(values);
  }
  FillGaps(table.elevation_rad);
}

/// The median or, with a reach, the mean of what is within it of the median.
double MeanNearMedian(std::vector<double>& values, double reach_rad) {
  const double median_rad = MedianOf(values);
  if (reach_rad == 0.0) return median_rad;
  double sum_rad = 0.0;
  double num = 0.0;
  for (const double value : values) {
    if (std::abs(value - median_rad) > reach_rad) continue;
    sum_rad += value;
    num += 1.0;
  }
  return sum_rad / num;
}

// Finds the columns' azimuths from those of the points less their rows' offsets. Each column
// continues from the one before it, so that the azimuth is unwrapped.
void FindColumns(const DirectionGrid& grid, double reach_rad, ScanTable& table) {
  table.column_azimuth_rad.assign(grid.columns, kUnknown);
  double last_rad = kUnknown;
  std::vector<double> values;
  for (std::size_t column = 0; column < grid.columns; ++column) {
    values.clear();
    for (std::size_t row = 0; row < grid.rows; ++row) {
      const double azimuth_rad = grid.azimuth_rad[row * grid.columns + column];
      if (std::isnan(azimuth_rad)) continue;
      const double own_rad = azimuth_rad - table.row_azimuth_rad[row];
      if (std::isnan(last_rad)) last_rad = own_rad;
      values.push_back(WrappedAngle_rad(own_rad - last_rad));
    }
    if (values.empty()) continue;
    last_rad += MeanNearMedian(values, reach_rad);
    table.column_azimuth_rad[column] = last_rad;
  }
  FillGaps(table.column_azimuth_rad);
}

void FindRowOffsets(const DirectionGrid& grid, double reach_rad, ScanTable& table) {
  std::vector<double> values;
  for (std::size_t row = 0; row < grid.rows; ++row) {
    values.clear();
    for (std::size_t column = 0; column < grid.columns; ++column) {
      const double azimuth_rad = grid.azimuth_rad[row * grid.columns + column];
      if (std::isnan(azimuth_rad)) continue;
      values.push_back(WrappedAngle_rad(azimuth_rad - table.column_azimuth_rad[column]));
    }
    if (!values.empty()) table.row_azimuth_rad[row] = MeanNearMedian(values, reach_rad);
  }
}

double MedianStep(const std::vector<double>& azimuths_rad) {
  std::vector<double> steps;
  for (std::size_t i = 1; i < azimuths_rad.size(); ++i) {
    const double step_rad = std::abs(azimuths_rad[i] - azimuths_rad[i - 1]);
    if (!std::isnan(step_rad)) steps.push_back(step_rad);
  }
  return MedianOf(steps);
}

// Half the distance between a row's two neighbours; at the ends, the whole distance to the only
// one.
std::vector<double> Heights(const std::vector<double>& elevations_rad) {
  std::vector<double> heights(elevations_rad.size(), kUnknown);
  for (std::size_t i = 0; i < heights.size(); ++i) {
    double sum = 0.0;
    int num = 0;
    for (const std::size_t k : {i - 1, i + 1}) {
      if (k >= heights.size() || std::isnan(elevations_rad[k] - elevations_rad[i])) continue;
      sum += std::abs(elevations_rad[k] - elevations_rad[i]);
      ++num;
    }
    if (num > 0) heights[i] = sum / num;
  }
  return heights;
}

// Derives from the columns' azimuths whether the turn is full and by how many columns rows are
// offset.
void FindTurn(ScanTable& table) {
  const auto is_known = [](double azimuth_rad) { return !std::isnan(azimuth_rad); };
  const auto& azimuths_rad = table.column_azimuth_rad;
  const auto first = std::find_if(azimuths_rad.begin(), azimuths_rad.end(), is_known);
  const auto last = std::find_if(azimuths_rad.rbegin(), azimuths_rad.rend(), is_known);
  const double span_rad = *last - *first;
  const double gap_rad = 2.0 * std::numbers::pi - std::abs(span_rad);
  // The last columns of a frame may end short of the full turn or go a little beyond it.
  constexpr double kMostSteps = 3.0;
  table.is_full_turn = std::abs(gap_rad) < kMostSteps * table.column_step_rad;
  const double step_rad = std::copysign(table.column_step_rad, span_rad);
  for (const double azimuth_rad : table.row_azimuth_rad) {
    table.row_shift.push_back(std::llround(azimuth_rad / step_rad));
  }
}

// Whether each row has one elevation. In a figure of loops, drawn by several lasers at once, rows
// lie beside each other, but each extends over the whole field of view.
bool HasLevelRows(const DirectionGrid& grid, const ScanTable& table) {
  constexpr double kMostSteps = 2.0;
  std::vector<double> deviations_rad;
  for (std::size_t place = 0; place < grid.elevation_rad.size(); ++place) {
    const double deviation_rad =
        std::abs(grid.elevation_rad[place] - table.elevation_rad[place / grid.columns]);
    if (!std::isnan(deviation_rad)) deviations_rad.push_back(deviation_rad);
  }
  return MedianOf(deviations_rad) < kMostSteps * table.row_step_rad;
}

/// @param num_settling Further passes, for rows that see other columns than each other: medians
///   leave an offset between them, which means carry on from row to row until it is none.
std::optional<ScanTable> TableOf(const DirectionGrid& grid, int num_settling = 0) {
  constexpr int kPasses = 3;
  ScanTable table;
  table.rows = grid.rows;
  table.columns = grid.columns;
  table.row_azimuth_rad.assign(grid.rows, 0.0);
  FindElevations(grid, table);
  for (int pass = 0; pass < kPasses; ++pass) {
    FindColumns(grid, 0.0, table);
    FindRowOffsets(grid, 0.0, table);
  }
  const double reach_rad = 0.5 * MedianStep(table.column_azimuth_rad);
  for (int pass = 0; pass < num_settling && reach_rad > 0.0; ++pass) {
    FindColumns(grid, reach_rad, table);
    FindRowOffsets(grid, reach_rad, table);
  }
  table.column_step_rad = MedianStep(table.column_azimuth_rad);
  table.row_height_rad = Heights(table.elevation_rad);
  std::vector<double> heights_rad = table.row_height_rad;
  std::erase_if(heights_rad, [](double height_rad) { return std::isnan(height_rad); });
  table.row_step_rad = MedianOf(heights_rad);
  if (!(table.column_step_rad > 0.0 && table.row_step_rad > 0.0)) return std::nullopt;
  if (!HasLevelRows(grid, table)) return std::nullopt;
  FindTurn(table);
  return table;
}

}  // namespace

std::array<double, 3> ScanTable::Direction(std::size_t row, std::size_t column) const {
  const double azimuth_rad = column_azimuth_rad[column] + row_azimuth_rad[row];
  const double level = std::cos(elevation_rad[row]);
  const Vector3 direction(level * std::cos(azimuth_rad), level * std::sin(azimuth_rad),
                          std::sin(elevation_rad[row]));
  if (!sensor_from_spin) return {direction.x(), direction.y(), direction.z()};
  const Vector3 turned = *sensor_from_spin * direction;
  return {turned.x(), turned.y(), turned.z()};
}

double ScanTable::SolidAngle_sr(std::size_t row) const {
  return std::cos(elevation_rad[row]) * row_height_rad[row] * column_step_rad;
}

Vector3 SpinPoint_m(const Frame& frame, std::size_t slot) {
  const Vector3 point_m(static_cast<double>(frame.x[slot]), static_cast<double>(frame.y[slot]),
                        static_cast<double>(frame.z[slot]));
  return frame.sensor_from_spin ? Vector3(frame.sensor_from_spin->transpose() * point_m) : point_m;
}

AimedPoint SeenFromBeam(const std::array<double, 2>& origin_m,
                        double channel_azimuth_rad,
                        const Frame& frame,
                        std::size_t slot) {
  const Vector3 point_m = SpinPoint_m(frame, slot);
  const double up_m = point_m.z() - origin_m[1];
  const double from_axis_m = std::hypot(point_m.x(), point_m.y());
  const double along_m = origin_m[0] * std::cos(channel_azimuth_rad);
  const double aside_m = origin_m[0] * std::sin(channel_azimuth_rad);
  const double level_m =
      std::sqrt(std::max(0.0, from_axis_m * from_axis_m - aside_m * aside_m)) - along_m;
  const double rotor_rad = std::atan2(point_m.y(), point_m.x()) -
                           std::atan2(level_m * std::sin(channel_azimuth_rad),
                                      origin_m[0] + level_m * std::cos(channel_azimuth_rad));
  return {.azimuth_rad = rotor_rad + channel_azimuth_rad,
          .elevation_rad = std::atan2(up_m, level_m)};
}

std::optional<ScanTable> MakeScanTable(const Frame& frame,
                                       const std::array<double, 2>& origin_m,
                                       std::span<const double> aside_rad) {
  if (frame.rows < 2 || frame.columns < 2) return std::nullopt;
  DirectionGrid grid(frame.rows, frame.columns);
  for (std::size_t place = 0; place < grid.azimuth_rad.size(); ++place) {
    const std::size_t end = (place + 1) * frame.returns;
    std::size_t slot = place * frame.returns;
    while (slot < end && !std::isfinite(frame.range_m[slot])) ++slot;
    if (slot == end) continue;
    const double beam_rad = aside_rad.empty() ? 0.0 : aside_rad[place / frame.columns];
    const AimedPoint seen = SeenFromBeam(origin_m, beam_rad, frame, slot);
    grid.azimuth_rad[place] = seen.azimuth_rad;
    grid.elevation_rad[place] = seen.elevation_rad;
  }
  constexpr int kUntilSettled = 30;
  auto table = TableOf(grid, aside_rad.empty() ? 0 : kUntilSettled);
  if (table) table->sensor_from_spin = frame.sensor_from_spin;
  return table;
}

std::optional<ScanTable> MakeScanTable(const ScanPattern& pattern) {
  if (pattern.rows < 2 || pattern.columns < 2 || !pattern.repeats()) return std::nullopt;
  DirectionGrid grid(pattern.rows, pattern.columns);
  for (std::size_t i = 0; i < pattern.num_firings(); ++i) {
    grid.Set(std::size_t{pattern.row[i]} * pattern.columns + pattern.column[i],
             static_cast<double>(pattern.direction_x[i]),
             static_cast<double>(pattern.direction_y[i]),
             static_cast<double>(pattern.direction_z[i]));
  }
  return TableOf(grid);
}

}  // namespace railcast
