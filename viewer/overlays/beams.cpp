#include "viewer/overlays/overlays.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>

#include "core/base/error.h"
#include "core/io/cloud/scan_motion.h"
#include "core/io/recording/firing_truth.h"
#include "core/io/recording/scan_table.h"
#include "viewer/color/palette.h"

namespace railcast {

namespace {

bool IsEmpty(const Frame& frame, std::size_t firing) {
  const auto first =
      frame.range_m.begin() + static_cast<std::ptrdiff_t>(firing * std::size_t{frame.returns});
  return std::none_of(first, first + frame.returns,
                      [](float range_m) { return std::isfinite(range_m); });
}

Beams MakeBeams(std::uint32_t rows, std::uint32_t columns) {
  constexpr float kNaN = std::numeric_limits<float>::quiet_NaN();
  const std::size_t num_beams = std::size_t{rows} * columns;
  return {.rows = rows,
          .columns = columns,
          .directions = std::vector<Eigen::Vector3f>(num_beams, {kNaN, kNaN, kNaN}),
          .times_ns = std::vector<std::uint32_t>(num_beams)};
}

}  // namespace

Overlay DrawEmptyBeams(const RecordedFrame& recorded, const Beams& beams) {
  Overlay drawing;
  const Frame& frame = recorded.frame;
  if (!recorded.is_grid) return drawing;
  Check(beams.rows == frame.rows && beams.columns == frame.columns, "beams are those of the frame");
  const bool has_outcomes = HasAllOutcomes(recorded);
  const bool has_true_ranges = recorded.Has("true_range_m");
  const ScanMotion motion(frame);
  drawing.segments.reserve(beams.directions.size());
  for (std::size_t firing = 0; firing < beams.directions.size(); ++firing) {
    const Vector3 direction = beams.directions[firing].cast<double>();
    if (!IsEmpty(frame, firing) || !direction.allFinite()) continue;
    const std::size_t slot = firing * frame.returns;
    const bool has_end = has_true_ranges && std::isfinite(frame.true_range_m[slot]);
    const double end_m = has_end ? static_cast<double>(frame.true_range_m[slot]) : kEmptyBeamStub_m;
    const double start_m = end_m > kEmptyBeamStart_m ? kEmptyBeamStart_m : 0.0;
    AddSegment(motion.AtStamp(start_m * direction, beams.times_ns[firing]),
               motion.AtStamp(end_m * direction, beams.times_ns[firing]),
               has_outcomes ? OutcomeRgb(frame.outcome[slot]) : kUnknownOutcomeRgb, drawing);
    drawing.segments.back().opacity = has_end ? kLostBeamOpacity : kOpenBeamOpacity;
  }
  return drawing;
}

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
