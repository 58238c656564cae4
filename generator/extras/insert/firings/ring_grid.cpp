#include "generator/extras/insert/firings/ring_grid.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <numeric>

#include "core/base/error.h"
#include "core/base/text.h"
#include "core/base/units.h"
#include "railcast/io/recording.h"

namespace railcast {
namespace {

constexpr double kWholeTurn_rad = 2.0 * std::numbers::pi;
constexpr double kNoAzimuth = std::numeric_limits<double>::quiet_NaN();

/// Returns the step of the columns, signed: the mean of those that follow each other, whether with
/// a gap or not.
double StepOf(const std::vector<double>& azimuths_rad, double usual_rad) {
  std::int64_t balance = 0;
  for (std::size_t i = 1; i < azimuths_rad.size(); ++i) {
    if (azimuths_rad[i] > azimuths_rad[i - 1]) ++balance;
    if (azimuths_rad[i] < azimuths_rad[i - 1]) --balance;
  }
  double step_rad = usual_rad;
  for (int pass = 0; pass < 3; ++pass) {
    double sum_rad = 0.0;
    double num = 0.0;
    for (std::size_t i = 1; i < azimuths_rad.size(); ++i) {
      const double one_rad = std::abs(azimuths_rad[i] - azimuths_rad[i - 1]);
      constexpr double kMostSteps = 4.5;
      if (!(one_rad < kMostSteps * step_rad)) continue;
      sum_rad += one_rad;
      num += std::max(1.0, std::round(one_rad / step_rad));
    }
    if (num > 0.0) step_rad = sum_rad / num;
  }
  return balance < 0 ? -step_rad : step_rad;
}

/// Columns go on in the sense of rotation: a step back is a long way on, such as from the end of an
/// azimuth window to its begin.
std::vector<double> TurnOn(std::vector<double> azimuths_rad, double step_rad) {
  double added_rad = 0.0;
  double last_rad = kNoAzimuth;
  for (double& azimuth_rad : azimuths_rad) {
    if (std::isnan(azimuth_rad)) continue;
    constexpr double kMostBack_steps = 4.5;
    azimuth_rad += added_rad;
    if ((azimuth_rad - last_rad) / step_rad < -kMostBack_steps) {
      added_rad += std::copysign(kWholeTurn_rad, step_rad);
      azimuth_rad += std::copysign(kWholeTurn_rad, step_rad);
    }
    last_rad = azimuth_rad;
  }
  return azimuths_rad;
}

/// How far a ring may lie from its channel. Units differ from the table of their kind by about
/// 0.1 deg (scenarios/sensors/README.md).
constexpr double kMostBeside_deg = 0.35;
/// The elevation of a ring with fewer points may be that of strays.
constexpr std::size_t kFewPoints = 8;

std::string DegText(double angle_rad) {
  return NumberText(std::round(100.0 * DegFromRad(angle_rad)) / 100.0) + " deg";
}

/// Matches rising values with rising values of which there are as many or more.
std::vector<std::uint32_t> MatchRising(const std::vector<double>& values,
                                       std::span<const double> candidates) {
  const std::size_t num = candidates.size();
  // The least cost of the values so far if the last is matched with one of the first j candidates.
  std::vector<double> cost(num + 1, 0.0);
  std::vector<std::vector<bool>> takes(values.size(), std::vector<bool>(num + 1));
  for (std::size_t i = 0; i < values.size(); ++i) {
    std::vector<double> next(num + 1, std::numeric_limits<double>::infinity());
    for (std::size_t j = 1; j <= num; ++j) {
      const double taken = cost[j - 1] + std::abs(values[i] - candidates[j - 1]);
      takes[i][j] = taken < next[j - 1];
      next[j] = std::min(taken, next[j - 1]);
    }
    cost = std::move(next);
  }
  std::vector<std::uint32_t> match(values.size());
  std::size_t j = num;
  for (std::size_t i = values.size(); i-- > 0; --j) {
    while (!takes[i][j]) --j;
    match[i] = static_cast<std::uint32_t>(j - 1);
  }
  return match;
}

}  // namespace

bool IsInWindow(const SpinningSpec& sensor, double rotor_deg, double margin_deg) {
  if (!sensor.azimuth_window_deg) return true;
  constexpr double kTurn_deg = 360.0;
  const auto [begin_deg, end_deg] = *sensor.azimuth_window_deg;
  const double width_deg = end_deg - begin_deg + (end_deg > begin_deg ? 0.0 : kTurn_deg);
  const double turns = (rotor_deg - begin_deg + margin_deg) / kTurn_deg;
  return kTurn_deg * (turns - std::floor(turns)) < width_deg + 2.0 * margin_deg;
}

TurnColumns ColumnsOfTurn(const SpinningSpec& sensor, double left, const ScanTable& table) {
  const double step_rad = StepOf(table.column_azimuth_rad, table.column_step_rad);
  const std::vector<double> azimuths_rad = TurnOn(table.column_azimuth_rad, step_rad);
  TurnColumns turn{.of_old = {}, .azimuth_rad = {}, .step_rad = step_rad};
  const auto add_empty = [&](double azimuth_rad) {
    // Lasers look at most so far beside the rotor's azimuth.
    constexpr double kMargin_deg = 15.0;
    if (!IsInWindow(sensor, left * DegFromRad(azimuth_rad), kMargin_deg)) return;
    turn.azimuth_rad.push_back(azimuth_rad);
  };
  double last_rad = kNoAzimuth;
  const auto known = std::ranges::find_if(azimuths_rad, [](double a) { return !std::isnan(a); });
  const auto num_before = static_cast<double>(known - azimuths_rad.begin());
  double next_rad = *known - num_before * turn.step_rad;
  for (const double known_rad : azimuths_rad) {
    const double azimuth_rad = std::isnan(known_rad) ? next_rad : known_rad;
    const double steps = std::isnan(last_rad) ? 1.0 : (azimuth_rad - last_rad) / turn.step_rad;
    const auto num_steps = std::max<std::int64_t>(1, std::llround(steps));
    for (std::int64_t i = 1; i < num_steps; ++i) {
      const double share = static_cast<double>(i) / static_cast<double>(num_steps);
      add_empty(last_rad + share * (azimuth_rad - last_rad));
    }
    turn.of_old.push_back(static_cast<std::uint32_t>(turn.azimuth_rad.size()));
    turn.azimuth_rad.push_back(azimuth_rad);
    last_rad = azimuth_rad;
    next_rad = last_rad + turn.step_rad;
  }
  const double gap_rad = kWholeTurn_rad - std::abs(last_rad - turn.azimuth_rad.front());
  const std::int64_t num_more = std::llround(gap_rad / std::abs(turn.step_rad)) - 1;
  for (std::int64_t i = 0; i < num_more; ++i, next_rad += turn.step_rad) add_empty(next_rad);
  return turn;
}

std::vector<std::uint32_t> ChannelsOfRows(std::span<const RecordedRow> rows,
                                          std::span<const double> elevations_rad) {
  std::vector<std::size_t> known;
  std::vector<double> known_rad;
  for (std::size_t row = 0; row < rows.size(); ++row) {
    if (rows[row].num_points == 0) continue;
    known.push_back(row);
    known_rad.push_back(rows[row].elevation_rad);
  }
  if (known.size() > elevations_rad.size()) {
    throw InputError("the sensor has " + NumberText(elevations_rad.size()) +
                     " channels, the recording " + NumberText(known.size()) + " rings");
  }
  const std::vector<std::uint32_t> match = MatchRising(known_rad, elevations_rad);
  std::vector<std::uint32_t> channels(rows.size(), kNoSlot);
  bool are_same = rows.size() == elevations_rad.size();
  for (std::size_t i = 0; i < known.size(); ++i) {
    const double channel_rad = elevations_rad[match[i]];
    const bool is_beside = std::abs(DegFromRad(known_rad[i] - channel_rad)) > kMostBeside_deg;
    if (is_beside && rows[known[i]].num_points >= kFewPoints) {
      throw InputError("ring " + NumberText(known[i]) + " of " + NumberText(rows.size()) +
                       " lies at " + DegText(known_rad[i]) + ", the sensor's channel at " +
                       DegText(channel_rad));
    }
    channels[known[i]] = match[i];
    are_same = are_same && match[i] == known[i];
  }
  if (are_same) std::iota(channels.begin(), channels.end(), 0U);
  return channels;
}

}  // namespace railcast
