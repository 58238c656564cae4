#include "analysis/extras/preset/receiver_figures.h"

#include <algorithm>
#include <cmath>

#include "analysis/estimate/streams.h"
#include "analysis/stats/holes.h"

namespace railcast {
namespace {

TwoDeviations TwoOf(const TurnNoise::Deviations& of) {
  return {EstimateOf(of.robust), EstimateOf(of.rms)};
}

/// By how much a channel is brighter than the mean of its neighbours, the median in even and in odd
/// sectors of 30 deg.
std::array<double, 2> BrighterBy(const std::vector<SmoothTurn>& turns,
                                 std::size_t below,
                                 std::size_t row,
                                 std::size_t above) {
  constexpr double kSameRange = 0.05;
  std::array<std::vector<double>, 2> differences;
  for (const SmoothTurn& turn : turns) {
    for (std::size_t column = 0; column < turn.scan.columns; ++column) {
      const auto low_column = turn.scan.ColumnBeside(row, column, below);
      const auto high_column = turn.scan.ColumnBeside(row, column, above);
      if (!low_column || !high_column) continue;
      const std::size_t at = turn.At(row, column);
      const std::size_t low = turn.At(below, *low_column);
      const std::size_t high = turn.At(above, *high_column);
      const double difference =
          turn.log_intensity[at] - 0.5 * (turn.log_intensity[low] + turn.log_intensity[high]);
      const double apart_m = turn.range_m[at] - 0.5 * (turn.range_m[low] + turn.range_m[high]);
      if (std::isnan(difference) || std::abs(apart_m) > kSameRange * turn.range_m[at]) continue;
      differences.at(SectorOf(turn.scan, row, column) / 3 % 2).push_back(difference);
    }
  }
  return {Median(differences[0]).value, Median(differences[1]).value};
}

Estimate ChannelGain(const std::vector<SmoothTurn>& turns) {
  const std::vector<double>& elevation_rad = turns.front().scan.elevation_rad;
  std::vector<std::size_t> order;
  for (std::size_t row = 0; row < elevation_rad.size(); ++row) {
    if (!std::isnan(elevation_rad[row])) order.push_back(row);
  }
  std::ranges::sort(order, {}, [&](std::size_t row) { return elevation_rad[row]; });
  std::vector<std::array<double, 2>> channels;
  for (std::size_t i = 1; i + 1 < order.size(); ++i) {
    const auto medians = BrighterBy(turns, order[i - 1], order[i], order[i + 1]);
    if (std::isfinite(medians[0] + medians[1])) channels.push_back(medians);
  }
  const auto deviation = [&](std::size_t left_out) {
    constexpr double kOfThree = 1.5;  // Variance of a gain less the mean of two others.
    Moments even, odd, sum;
    for (std::size_t i = 0; i < channels.size(); ++i) {
      if (i == left_out) continue;
      even.Add(channels[i][0]);
      odd.Add(channels[i][1]);
      sum.Add(channels[i][0] + channels[i][1]);
    }
    const auto variance = [](const Moments& of) {
      return std::pow(of.StandardDeviation().value, 2);
    };
    const double covariance = 0.5 * (variance(sum) - variance(even) - variance(odd));
    return std::sqrt(std::max(0.0, covariance) / kOfThree);
  };
  return EstimateOf(Jackknife(deviation, std::vector<std::uint64_t>(channels.size(), 1)));
}

}  // namespace

Estimate EstimateOf(const JackknifedFigure& figure) {
  if (std::isnan(figure.value)) return NotEnough(figure.num);
  const double half = StudentQuantile(static_cast<double>(figure.num_parts) - 1.0) * figure.error;
  return {figure.value, figure.value - half, figure.value + half, figure.num};
}

ReceiverFigures FindReceiverFigures(const std::vector<RecordedFrame>& turns) {
  Holes holes;
  for (const RecordedFrame& turn : turns) holes.Add(turn);
  ReceiverFigures figures;
  figures.holes = holes.Share();
  const GridTurns grids = GridsOf(turns);
  if (grids.frames.empty()) return figures;
  const std::vector<SmoothTurn> seen = SmoothTurnsOf(grids);
  const TurnNoise noise = FindTurnNoise(seen);
  figures.has_moved = noise.has_moved;
  figures.intensity_noise = TwoOf(noise.intensity);
  figures.range_noise_m = TwoOf(noise.range_m);
  for (std::size_t lag = 0; lag < noise.texture.size(); ++lag) {
    figures.texture.at(lag) = TwoOf(noise.texture.at(lag));
  }
  figures.channel_gain = ChannelGain(seen);
  figures.jumps = FindJumpLosses(grids);
  return figures;
}

}  // namespace railcast
