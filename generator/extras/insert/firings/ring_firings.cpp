#include "generator/extras/insert/firings/ring_firings.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <numbers>

#include "core/base/error.h"
#include "core/base/median.h"
#include "core/base/text.h"
#include "core/base/units.h"
#include "core/io/recording/scan_table.h"
#include "core/scan/spinning_pattern.h"
#include "generator/extras/insert/firings/frame_slots.h"
#include "generator/extras/insert/firings/ring_grid.h"
#include "railcast/frame.h"

namespace railcast {
namespace {

constexpr double kTurn_rad = 2.0 * std::numbers::pi;
constexpr double kUnknown = std::numeric_limits<double>::quiet_NaN();
/// How much a step may differ from the sensor's at its rate: rotors keep theirs to a few percent.
constexpr double kMostStepError = 0.1;

/// The sensor's channels by row, with azimuths to the left as the axes count them.
struct Channels {
  std::vector<double> elevation_rad;
  std::vector<double> azimuth_rad;  ///< Added to the rotor's.
  std::vector<double> time_us;
  double left{};  ///< 1 if the rotor turns to the left, -1 if to the right.
  std::array<double, 2> origin_m{};
};

Channels ChannelsOf(const SpinningSpec& sensor) {
  const std::vector<std::uint16_t> rows = RowsByElevation(sensor.channels);
  const std::vector<double> empty(rows.size());
  Channels channels{empty, empty, empty,
                    sensor.rotation == Rotation::kCounterclockwise ? 1.0 : -1.0,
                    sensor.beam_origin_m.value_or(std::array{0.0, 0.0})};
  for (std::size_t i = 0; i < rows.size(); ++i) {
    channels.elevation_rad[rows[i]] = RadFromDeg(sensor.channels[i].elevation_deg);
    channels.azimuth_rad[rows[i]] = channels.left * RadFromDeg(sensor.channels[i].azimuth_deg);
    channels.time_us[rows[i]] = sensor.channels[i].time_us;
  }
  return channels;
}

std::vector<RecordedRow> RowsOfTable(const ScanTable& table, const Frame& frame) {
  std::vector<RecordedRow> rows;
  for (const double elevation_rad : table.elevation_rad) rows.push_back({elevation_rad, 0});
  for (std::size_t slot = 0; slot < frame.num_slots(); ++slot) {
    if (!std::isnan(frame.x[slot])) ++rows[slot / frame.width()].num_points;
  }
  return rows;
}

void CheckAzimuthStep(double step_rad, double sensor_step_rad) {
  const double ratio = std::abs(step_rad) / sensor_step_rad;
  if (std::abs(ratio - 1.0) <= kMostStepError) return;
  const auto text = [](double angle_rad) {
    return NumberText(std::round(1e4 * DegFromRad(angle_rad)) / 1e4) + " deg";
  };
  throw InputError("the sensor turns by " + text(sensor_step_rad) +
                   " from firing to firing of a channel, the recording's by " +
                   text(std::abs(step_rad)));
}

/// The firings of the rows of a turn.
struct TurnRows {
  std::vector<std::uint32_t> of_old;
  std::vector<double> elevation_rad;
  std::vector<double> azimuth_rad;  ///< Added to the column's.
};

/// The mean of angles that are known but for multiples of `step_rad`.
double MeanWithin(const std::vector<double>& angles_rad, double step_rad) {
  double sine = 0.0;
  double cosine = 0.0;
  for (const double angle_rad : angles_rad) {
    sine += std::sin(kTurn_rad * angle_rad / step_rad);
    cosine += std::cos(kTurn_rad * angle_rad / step_rad);
  }
  return std::atan2(sine, cosine) / kTurn_rad * step_rad;
}

// NOLINTNEXTLINE(readability-function-size): what was measured of the rows
TurnRows RowsOfTurn(const ScanTable& table,
                    const Channels& channels,
                    std::vector<std::uint32_t> of_old,
                    const std::vector<RecordedRow>& rows,
                    double rad_per_us,
                    double step_rad) {
  TurnRows turn{.of_old = std::move(of_old),
                .elevation_rad = channels.elevation_rad,
                .azimuth_rad = channels.azimuth_rad};
  for (std::size_t c = 0; c < turn.azimuth_rad.size(); ++c) {
    turn.azimuth_rad[c] += rad_per_us * channels.time_us[c];
  }
  std::vector<double> shifts_rad;
  std::vector<double> rises_rad;
  for (std::size_t row = 0; row < rows.size(); ++row) {
    if (rows[row].num_points == 0) continue;
    const std::uint32_t c = turn.of_old[row];
    shifts_rad.push_back(table.row_azimuth_rad[row] - turn.azimuth_rad[c]);
    rises_rad.push_back(table.elevation_rad[row] - channels.elevation_rad[c]);
  }
  // Columns are firing cycles, or the azimuths of points wherever the lasers look.
  const auto [least, most] = std::ranges::minmax(shifts_rad);
  const double size_rad = std::abs(step_rad);
  const bool are_cycles = most - least < 0.5 * size_rad;
  const double shift_rad = are_cycles ? MedianOf(shifts_rad) : MeanWithin(shifts_rad, size_rad);
  const double rise_rad = MedianOf(rises_rad);
  for (std::size_t c = 0; c < turn.azimuth_rad.size(); ++c) {
    turn.elevation_rad[c] += rise_rad;
    turn.azimuth_rad[c] += shift_rad;
    if (!are_cycles) turn.azimuth_rad[c] = std::remainder(turn.azimuth_rad[c], size_rad);
  }
  for (std::size_t row = 0; row < rows.size(); ++row) {
    if (rows[row].num_points == 0) continue;
    turn.elevation_rad[turn.of_old[row]] = table.elevation_rad[row];
    turn.azimuth_rad[turn.of_old[row]] = table.row_azimuth_rad[row];
  }
  return turn;
}

NewSlots SlotsOfTurn(const TurnRows& rows, const TurnColumns& columns, const Frame& frame) {
  NewSlots to{static_cast<std::uint32_t>(rows.elevation_rad.size()),
              static_cast<std::uint32_t>(columns.azimuth_rad.size()),
              frame.returns,
              {}};
  for (std::size_t slot = 0; slot < frame.num_slots(); ++slot) {
    const std::size_t row = slot / frame.width();
    const std::size_t column = slot / frame.returns % frame.columns;
    const std::uint32_t new_row = rows.of_old[row];
    const std::uint32_t cell = new_row * to.columns + columns.of_old[column];
    to.of_slot.push_back(new_row == kNoSlot ? kNoSlot
                                            : cell * frame.returns +
                                                  static_cast<std::uint32_t>(slot % frame.returns));
  }
  return to;
}

/// The firings of a frame that has the shape of its turn.
class TurnFirings {
 public:
  TurnFirings(const SpinningSpec& sensor,
              const Channels& channels,
              const TurnRows& rows,
              const TurnColumns& columns,
              const RecordedFrame& recorded)
      : sensor_(sensor),
        channels_(channels),
        rows_(rows),
        columns_(columns),
        recorded_(recorded),
        us_per_rad_(sensor.cycle_us / std::abs(columns.step_rad)) {
    FindAims();
    FindTimes();
  }

  [[nodiscard]] std::vector<GivenFiring> All() const {
    std::vector<GivenFiring> firings;
    for (std::size_t cell = 0; cell < aims_.size(); ++cell) {
      if (IsFired(cell)) firings.push_back(FiringOf(cell));
    }
    return firings;
  }

 private:
  /// A firing as its cell or its point has it.
  struct Aim {
    double azimuth_rad{};  ///< Unwrapped, like the columns'.
    double elevation_rad{};
    bool has_point{};
    double rotor_us{};  ///< Time at which the rotor is there, from where its azimuth is 0.
  };

  void FindAims() {
    const Frame& frame = recorded_.frame;
    for (std::uint32_t row = 0; row < frame.rows; ++row) {
      for (std::uint32_t column = 0; column < frame.columns; ++column) {
        Aim aim{.azimuth_rad = columns_.azimuth_rad[column] + rows_.azimuth_rad[row],
                .elevation_rad = rows_.elevation_rad[row]};
        TakePoint(row, column, aim);
        aim.rotor_us =
            channels_.left * (aim.azimuth_rad - channels_.azimuth_rad[row]) * us_per_rad_;
        aims_.push_back(aim);
      }
    }
  }

  void TakePoint(std::uint32_t row, std::uint32_t column, Aim& aim) const {
    const Frame& frame = recorded_.frame;
    const std::size_t first = (std::size_t{row} * frame.columns + column) * frame.returns;
    for (std::size_t slot = first; slot < first + frame.returns; ++slot) {
      if (std::isnan(frame.x[slot])) continue;
      const AimedPoint seen =
          SeenFromBeam(channels_.origin_m, channels_.azimuth_rad[row], frame, slot);
      aim.azimuth_rad += WrappedAngle_rad(seen.azimuth_rad - aim.azimuth_rad);
      aim.elevation_rad = seen.elevation_rad;
      aim.has_point = true;
      return;
    }
  }

  /// Finds by how much the times of each column differ from the rotor's.
  void FindTimes() {
    const Frame& frame = recorded_.frame;
    late_us_.assign(frame.columns, kUnknown);
    if (!recorded_.Has("time_ns")) {
      double first_us = std::numeric_limits<double>::infinity();
      for (const Aim& aim : aims_) first_us = std::min(first_us, aim.rotor_us);
      std::ranges::fill(late_us_, -first_us);
      return;
    }
    for (std::uint32_t column = 0; column < frame.columns; ++column) {
      std::vector<double> late_us;
      for (std::size_t row = 0; row < frame.rows; ++row) {
        const std::size_t cell = row * frame.columns + column;
        if (aims_[cell].has_point) late_us.push_back(TimeOfPoint(cell) - aims_[cell].rotor_us);
      }
      late_us_[column] = MedianOf(late_us);
    }
    TakeFromNearest(late_us_);
  }

  /// In us, that of the first return.
  [[nodiscard]] double TimeOfPoint(std::size_t cell) const {
    const Frame& frame = recorded_.frame;
    std::size_t slot = cell * frame.returns;
    while (std::isnan(frame.x[slot])) ++slot;
    return 1e-3 * frame.time_ns[slot];
  }

  /// Gives what is unknown the value of the nearest that is known.
  static void TakeFromNearest(std::vector<double>& values) {
    std::vector<std::size_t> known;
    for (std::size_t i = 0; i < values.size(); ++i) {
      if (!std::isnan(values[i])) known.push_back(i);
    }
    for (std::size_t i = 0, k = 0; i < values.size(); ++i) {
      const auto way = [&](std::size_t j) { return known[j] > i ? known[j] - i : i - known[j]; };
      while (k + 1 < known.size() && way(k + 1) <= way(k)) ++k;
      values[i] = values[known[k]];
    }
  }

  [[nodiscard]] bool IsFired(std::size_t cell) const {
    const std::size_t row = cell / recorded_.frame.columns;
    const double rotor_rad = aims_[cell].azimuth_rad - channels_.azimuth_rad[row];
    return aims_[cell].has_point ||
           IsInWindow(sensor_, channels_.left * DegFromRad(rotor_rad), 0.0);
  }

  [[nodiscard]] GivenFiring FiringOf(std::size_t cell) const {
    const Aim& aim = aims_[cell];
    const std::size_t row = cell / recorded_.frame.columns;
    const std::size_t column = cell % recorded_.frame.columns;
    const double level = std::cos(aim.elevation_rad);
    const double rotor_rad = aim.azimuth_rad - channels_.azimuth_rad[row];
    const auto to_float = [&](double x, double y, double z) {
      Vector3 turned(x, y, z);
      if (recorded_.frame.sensor_from_spin) turned = *recorded_.frame.sensor_from_spin * turned;
      return std::array{static_cast<float>(turned.x()), static_cast<float>(turned.y()),
                        static_cast<float>(turned.z())};
    };
    return {
        .direction = to_float(level * std::cos(aim.azimuth_rad), level * std::sin(aim.azimuth_rad),
                              std::sin(aim.elevation_rad)),
        .origin_m = to_float(channels_.origin_m[0] * std::cos(rotor_rad),
                             channels_.origin_m[0] * std::sin(rotor_rad), channels_.origin_m[1]),
        .time_ns = TimeOf(cell),
        .row = static_cast<std::uint16_t>(row),
        .column = static_cast<std::uint32_t>(column)};
  }

  [[nodiscard]] std::uint32_t TimeOf(std::size_t cell) const {
    const bool is_stated = aims_[cell].has_point && recorded_.Has("time_ns");
    const double turn_us = kTurn_rad * us_per_rad_;
    double time_us = is_stated ? TimeOfPoint(cell)
                               : aims_[cell].rotor_us + late_us_[cell % recorded_.frame.columns];
    // Columns without a point between the last one and the first belong to this turn, too.
    if (!is_stated) time_us -= turn_us * std::floor(time_us / turn_us);
    return static_cast<std::uint32_t>(std::llround(1e3 * time_us));
  }

  const SpinningSpec& sensor_;
  const Channels& channels_;
  const TurnRows& rows_;
  const TurnColumns& columns_;
  const RecordedFrame& recorded_;
  double us_per_rad_;
  std::vector<Aim> aims_;
  std::vector<double> late_us_;
};

/// Throws if the times of the points say that the rotor turns the other way.
void CheckSense(const ScanTable& table, const Channels& channels, const RecordedFrame& recorded) {
  if (!recorded.Has("time_ns")) return;
  const Frame& frame = recorded.frame;
  std::int64_t balance = 0;
  for (std::size_t slot = frame.returns; slot < frame.num_slots(); slot += frame.returns) {
    const std::size_t before = slot - frame.returns;
    if (std::isnan(frame.x[slot]) || std::isnan(frame.x[before])) continue;
    const std::size_t column = slot / frame.returns % frame.columns;
    if (column == 0) continue;
    const double way_rad = table.column_azimuth_rad[column] - table.column_azimuth_rad[column - 1];
    if (frame.time_ns[slot] == frame.time_ns[before]) continue;
    const bool is_later = frame.time_ns[slot] > frame.time_ns[before];
    balance += is_later == (way_rad * channels.left > 0.0) ? 1 : -1;
  }
  if (balance >= 0) return;
  const auto text = [](bool is_left) { return is_left ? "counterclockwise" : "clockwise"; };
  throw InputError(std::string("the sensor turns ") + text(channels.left > 0.0) +
                   ", the recording's " + text(channels.left < 0.0) +
                   ", as where axes are exchanged or mirrored");
}

}  // namespace

std::vector<GivenFiring> FindRingFirings(const SpinningSpec& sensor,
                                         double rate_hz,
                                         RecordedFrame& recorded) {
  const Channels channels = ChannelsOf(sensor);
  const auto found = MakeScanTable(recorded.frame, channels.origin_m);
  if (!found) throw InputError("its points are too few, or its rings are not level");
  const ScanTable& table = *found;
  const std::vector<RecordedRow> old_rows = RowsOfTable(table, recorded.frame);
  std::vector<std::uint32_t> row_channels = ChannelsOfRows(old_rows, channels.elevation_rad);
  const TurnColumns columns = ColumnsOfTurn(sensor, channels.left, table);
  const double sensor_step_rad = kTurn_rad * rate_hz * sensor.cycle_us / 1e6;
  CheckAzimuthStep(columns.step_rad, sensor_step_rad);
  CheckSense(table, channels, recorded);
  const double rad_per_us = channels.left * std::abs(columns.step_rad) / sensor.cycle_us;
  const TurnRows rows =
      RowsOfTurn(table, channels, std::move(row_channels), old_rows, rad_per_us, columns.step_rad);
  MoveSlots(SlotsOfTurn(rows, columns, recorded.frame), recorded);
  return TurnFirings(sensor, channels, rows, columns, recorded).All();
}

}  // namespace railcast
