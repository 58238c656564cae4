#include "core/io/recording/turn_frame.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/io/velodyne/reflectivity.h"
#include "core/scan/channel_rows.h"

namespace railcast {
namespace {

constexpr float kNoPoint = std::numeric_limits<float>::quiet_NaN();

float IntensityOf(const TurnPoint& point, IntensityBytes bytes) {
  if (bytes == IntensityBytes::kVelodyne) return IntensityOfByte(point.intensity);
  return static_cast<float>(point.intensity) / 100.0F;
}

void FillSlots(const SensorTurn& turn, const TurnShape& shape, Frame& frame) {
  std::size_t slot = 0;
  for (std::uint32_t row = 0; row < frame.rows; ++row) {
    for (std::uint32_t column = 0; column < frame.columns; ++column) {
      const std::int64_t time_ns = turn.column_time_ns[column] + shape.row_time_ns[row];
      for (std::uint32_t r = 0; r < frame.returns; ++r, ++slot) {
        frame.time_ns[slot] = static_cast<std::uint32_t>(time_ns);
        frame.ring[slot] = static_cast<std::uint16_t>(row);
        frame.column[slot] = column;
        frame.return_index[slot] = static_cast<std::uint8_t>(r);
      }
    }
  }
}

void FillPoints(const SensorTurn& turn, const TurnShape& shape, Frame& frame) {
  for (const TurnPoint& point : turn.points) {
    const std::size_t first =
        (std::size_t{point.ring} * frame.columns + point.column) * std::size_t{frame.returns};
    const std::size_t slot = first + point.return_index;
    frame.x[slot] = point.x;
    frame.y[slot] = point.y;
    frame.z[slot] = point.z;
    frame.range_m[slot] = point.range_m;
    frame.intensity[slot] = IntensityOf(point, shape.intensity);
    for (std::size_t r = 0; r < frame.returns; ++r) ++frame.return_count[first + r];
  }
}

bool AreTimesKnown(const SensorTurn& turn, const TurnShape& shape) {
  const auto [first, last] = std::ranges::minmax(turn.column_time_ns);
  const std::int64_t longest_ns = *std::ranges::max_element(shape.row_time_ns);
  return first >= 0 && last + longest_ns <= std::numeric_limits<std::uint32_t>::max();
}

}  // namespace

TurnShape ShapeOfTurns(const std::vector<ChannelSpec>& channels, IntensityBytes intensity) {
  TurnShape shape{.row_time_ns = std::vector<std::int64_t>(channels.size()),
                  .intensity = intensity};
  const std::vector<std::uint16_t> rows = RowsByElevation(channels);
  for (std::size_t i = 0; i < channels.size(); ++i) {
    shape.row_time_ns[rows[i]] = std::llround(channels[i].time_us * 1e3);
  }
  return shape;
}

RecordedFrame MakeTurnFrame(const SensorTurn& turn,
                            const TurnShape& shape,
                            const std::string& name) {
  RecordedFrame recorded;
  recorded.name = name;
  recorded.is_grid = true;
  recorded.fields = {
      "x", "y", "z", "intensity", "range_m", "ring", "column", "return_index", "return_count"};
  Frame& frame = recorded.frame;
  frame.Resize(static_cast<std::uint32_t>(shape.row_time_ns.size()),
               static_cast<std::uint32_t>(turn.num_columns()), turn.is_dual ? 2 : 1);
  ForEachField(frame, [](std::string_view, std::string_view, auto& values) {
    using Value = typename std::remove_cvref_t<decltype(values)>::value_type;
    if constexpr (std::is_same_v<Value, float>) std::ranges::fill(values, kNoPoint);
  });
  frame.stamp_ns = turn.stamp_ns;
  FillSlots(turn, shape, frame);
  FillPoints(turn, shape, frame);
  if (AreTimesKnown(turn, shape)) {
    recorded.fields.emplace("time_ns");
    frame.duration_ns = *std::ranges::max_element(frame.time_ns);
  } else {
    std::ranges::fill(frame.time_ns, 0U);
  }
  return recorded;
}

}  // namespace railcast
