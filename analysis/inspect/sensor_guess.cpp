#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <utility>
#include <vector>

#include "analysis/inspect/inspection.h"
#include "core/io/sensor_tables.h"

namespace railcast {

namespace {

/// Gives each ring a channel of its own, in their order, so that the sum of the squared differences
/// is least, and returns that sum.
/// @pre There are at least as many channels as rings.
double LeastSquares_deg2(const std::vector<double>& rings_deg,
                         const std::vector<double>& channels_deg) {
  // The least sums with the first channels, for the rings so far.
  std::vector<double> least_deg2(channels_deg.size() + 1, 0.0);
  for (const double ring_deg : rings_deg) {
    std::vector<double> with_ring_deg2(least_deg2.size(), std::numeric_limits<double>::infinity());
    for (std::size_t i = 0; i < channels_deg.size(); ++i) {
      const double off_deg = ring_deg - channels_deg[i];
      with_ring_deg2[i + 1] = std::min(with_ring_deg2[i], least_deg2[i] + off_deg * off_deg);
    }
    least_deg2 = std::move(with_ring_deg2);
  }
  return least_deg2.back();
}

}  // namespace

std::vector<SensorGuess> GuessSensor(const std::vector<InspectedRing>& rings) {
  std::vector<double> rings_deg;
  for (const InspectedRing& ring : rings) {
    if (ring.elevation_deg.num() > 0) rings_deg.push_back(ring.elevation_deg.PlainMean());
  }
  std::ranges::sort(rings_deg);
  std::vector<SensorGuess> guesses;
  for (const SensorTableName& sensor : SensorTableNames()) {
    std::vector<double> channels_deg;
    for (const ChannelSpec& channel : SensorTable(sensor.file).channels) {
      channels_deg.push_back(channel.elevation_deg);
    }
    std::ranges::sort(channels_deg);
    // The highest and the lowest rings may have seen nothing.
    constexpr double kFewest = 0.8;
    const auto num = static_cast<double>(rings_deg.size());
    const auto num_channels = static_cast<double>(channels_deg.size());
    if (num > num_channels || num < kFewest * num_channels) continue;
    const double squares_deg2 = LeastSquares_deg2(rings_deg, channels_deg);
    guesses.push_back({sensor.product, std::sqrt(squares_deg2 / num)});
  }
  std::ranges::sort(guesses, {}, &SensorGuess::error_deg);
  return guesses;
}

}  // namespace railcast
