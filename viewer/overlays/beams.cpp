#include "viewer/overlays/beams.h"

#include <array>
#include <cstddef>
#include <limits>

#include "core/io/recording/scan_table.h"

namespace railcast {
namespace {

Beams MakeBeams(std::uint32_t rows, std::uint32_t columns) {
  constexpr float kNaN = std::numeric_limits<float>::quiet_NaN();
  const std::size_t num_beams = std::size_t{rows} * columns;
  return {.rows = rows,
          .columns = columns,
          .directions = std::vector<Eigen::Vector3f>(num_beams, {kNaN, kNaN, kNaN}),
          .times_ns = std::vector<std::uint32_t>(num_beams)};
}

}  // namespace

Beams BeamsOf(const ScanPattern& pattern) {
  Beams beams = MakeBeams(pattern.rows, pattern.columns);
  for (std::size_t i = 0; i < pattern.num_firings(); ++i) {
    const std::size_t place = std::size_t{pattern.row[i]} * pattern.columns + pattern.column[i];
    beams.directions[place] = {pattern.direction_x[i], pattern.direction_y[i],
                               pattern.direction_z[i]};
    beams.times_ns[place] = pattern.time_ns[i];
  }
  return beams;
}

std::optional<Beams> BeamsOf(const RecordedFrame& recorded) {
  const Frame& frame = recorded.frame;
  if (!recorded.is_grid) return std::nullopt;
  const std::optional<ScanTable> table = MakeScanTable(frame);
  if (!table) return std::nullopt;
  Beams beams = MakeBeams(frame.rows, frame.columns);
  for (std::size_t row = 0; row < beams.rows; ++row) {
    for (std::size_t column = 0; column < beams.columns; ++column) {
      const std::size_t place = row * beams.columns + column;
      const std::array<double, 3> direction = table->Direction(row, column);
      beams.directions[place] =
          Eigen::Vector3d(direction[0], direction[1], direction[2]).cast<float>();
      if (recorded.Has("time_ns")) beams.times_ns[place] = frame.time_ns[place * frame.returns];
    }
  }
  return beams;
}

}  // namespace railcast
