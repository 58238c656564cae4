#pragma once

#include <cmath>
#include <cstdint>
#include <limits>

namespace railcast {

/// Fewer samples give no figure, only "not enough".
inline constexpr std::uint64_t kMinSamples = 10;
/// Of every interval we state.
inline constexpr double kConfidence = 0.95;
/// What lies beyond each end of it.
inline constexpr double kTail = 0.5 * (1.0 - kConfidence);

/// A figure, the ends of its 95 % confidence interval, and how many samples it rests on. All three
/// are NaN where the samples were not enough.
struct Estimate {
  double value = std::numeric_limits<double>::quiet_NaN();
  double low = std::numeric_limits<double>::quiet_NaN();
  double high = std::numeric_limits<double>::quiet_NaN();
  std::uint64_t num{};

  [[nodiscard]] bool is_enough() const { return !std::isnan(value); }
};

/// "Not enough": only how many there were.
[[nodiscard]] inline Estimate NotEnough(std::uint64_t num) {
  Estimate estimate;
  estimate.num = num;
  return estimate;
}

/// The same figure in another unit.
[[nodiscard]] inline Estimate Scaled(const Estimate& estimate, double factor) {
  return {estimate.value * factor, estimate.low * factor, estimate.high * factor, estimate.num};
}

/// The share of `num` independent trials that succeeded, with Wilson's score interval (Wilson 1927,
/// JASA 22), which stays in [0, 1] and holds at 0 and `num` successes.
[[nodiscard]] Estimate Proportion(std::uint64_t num_successes, std::uint64_t num);

/// The rate of a Poisson count: `count` per `exposure`, with the exact interval (Garwood 1936,
/// Biometrika 28); not enough below kMinSamples and without exposure.
[[nodiscard]] Estimate PoissonRate(std::uint64_t count, double exposure);

}  // namespace railcast
