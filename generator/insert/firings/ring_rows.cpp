#include "generator/insert/firings/ring_rows.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

#include "core/base/error.h"
#include "core/base/text.h"
#include "core/base/units.h"
#include "railcast/io/recording.h"

namespace railcast {
namespace {

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
