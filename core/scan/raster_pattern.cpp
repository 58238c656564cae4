#include <cmath>

#include "core/base/units.h"
#include "core/scan/firing.h"

namespace railcast {
namespace {

constexpr double kMaxRows = 65536.0;  // Rings have 16 bits.
// Fraction of a cell: decimal degrees are not exact in binary.
constexpr double kWholeCellTolerance = 1e-6;

/// Number of cells in a field of view. Faults are appended to `errors`.
double NumCells(double fov_deg,
                double max_fov_deg,
                double resolution_deg,
                const std::string& place,
                ErrorList& errors) {
  if (!(fov_deg > 0.0 && fov_deg <= max_fov_deg)) {
    errors.Add(FaultOf(
        place, max_fov_deg > 180.0 ? "must be > 0 and <= 360" : "must be > 0 and <= 180", fov_deg));
    return 0.0;
  }
  const double num_cells = fov_deg / resolution_deg;
  const double whole = std::round(num_cells);
  if (whole < 1.0 || std::abs(num_cells - whole) > kWholeCellTolerance) {
    errors.Add(FaultOf(place, "must be a whole number of angular_resolution_deg", num_cells));
  }
  return whole;
}

}  // namespace

FiringGrid RasterFirings(const RasterSpec& spec, double rate_hz, ErrorList& errors) {
  const bool by_columns = spec.order == RasterOrder::kColumns;
  const double step_deg = spec.angular_resolution_deg;
  if (!(step_deg > 0.0 && std::isfinite(step_deg))) {
    errors.Add(FaultOf("/pattern/angular_resolution_deg", "must be > 0", step_deg));
    return {};
  }
  const double num_columns =
      NumCells(spec.horizontal_fov_deg, 360.0, step_deg, "/pattern/horizontal_fov_deg", errors);
  const double num_rows =
      NumCells(spec.vertical_fov_deg, 180.0, step_deg, "/pattern/vertical_fov_deg", errors);
  if (num_rows > kMaxRows) {
    errors.Add(FaultOf("/pattern/vertical_fov_deg", "must have at most 65536 cells", num_rows));
  }
  if (num_columns * num_rows > static_cast<double>(kMaxNumFirings)) {
    errors.Add(FaultOf("/pattern", "must have at most 16777216 firings", num_columns * num_rows));
  }
  if (!errors.empty()) return {};

  FiringGrid grid{.rows = static_cast<std::uint32_t>(num_rows),
                  .columns = static_cast<std::uint32_t>(num_columns),
                  .firings = {}};
  grid.firings.reserve(std::size_t{grid.rows} * grid.columns);
  const double period_ns = 1e9 / rate_hz;
  for (std::uint32_t column = 0; column < grid.columns; ++column) {
    for (std::uint32_t row = 0; row < grid.rows; ++row) {
      const double passed = by_columns ? column / num_columns : row / num_rows;
      grid.firings.push_back(
          {.azimuth_rad = RadFromDeg((0.5 * (num_columns - 1.0) - column) * step_deg),
           .elevation_rad = RadFromDeg((row - 0.5 * (num_rows - 1.0)) * step_deg),
           .time_ns = std::llround(period_ns * passed),
           .row = static_cast<std::uint16_t>(row),
           .column = column});
    }
  }
  return grid;
}

}  // namespace railcast
