#include "core/simulate/wind.h"

#include <cmath>
#include <numbers>

#include "core/base/random.h"

namespace railcast {
namespace {

constexpr double kTwoPi_rad = 2.0 * std::numbers::pi;
constexpr double kWidestTangent_rad = std::numbers::pi / 4.0;

double UnitOf(std::uint32_t word) {
  return static_cast<double>(UnitFloat(word));
}

/// The frequency f L / U below which lies that share of the variance.
double KaimalQuantile(double share) {
  return (std::pow(1.0 - share, -1.5) - 1.0) / 10.2;
}

double CosineOfTurns(double turns) {
  return std::cos(kTwoPi_rad * (turns - std::floor(turns)));
}

}  // namespace

Wind::Wind(const Vector3& velocity_mps, std::uint64_t seed)
    : speed_mps_(velocity_mps.norm()), seed_(seed) {
  if (!blows()) return;
  downwind_ = velocity_mps / speed_mps_;
  const Vector3 aside = Vector3::UnitZ().cross(downwind_);
  for (std::size_t i = 0; i < kNumWaves; ++i) {
    const auto words = RandomWords(seed, RandomUse::kGusts, 0, static_cast<std::uint32_t>(i));
    const double share = (static_cast<double>(i) + UnitOf(words[0])) / kNumWaves * kSlowShare;
    const double turns_per_m = KaimalQuantile(share) / kLength_m;
    const double slant_rad = kWidestTangent_rad * (2.0 * UnitOf(words[1]) - 1.0);
    waves_[i] = {turns_per_m * (downwind_ + std::tan(slant_rad) * aside), turns_per_m * speed_mps_,
                 UnitOf(words[2])};
  }
}

double Wind::Gust(const Vector3& place_m, double time_s) const {
  double sum = 0.0;
  for (const Wave& wave : waves_) {
    sum += CosineOfTurns(wave.turns_per_m.dot(place_m) - wave.frequency_hz * time_s +
                         wave.phase_turns);
  }
  return std::sqrt(2.0 / kNumWaves) * sum;
}

double Wind::Resonance(double frequency_hz, double damping, double width_m) const {
  const double x = frequency_hz * kLength_m / speed_mps_;
  const double spectrum = 6.8 * x / std::pow(1.0 + 10.2 * x, 5.0 / 3.0);
  const double eta = 4.6 * width_m / kLength_m * x;
  const double whole =
      eta > 0.0 ? 1.0 / eta - (1.0 - std::exp(-2.0 * eta)) / (2.0 * eta * eta) : 1.0;
  return std::numbers::pi / (4.0 * damping) * spectrum * whole;
}

double Ringing(const std::array<std::uint32_t, 4>& words,
               double frequency_hz,
               double damping,
               double time_s) {
  double sum = 0.0;
  for (std::size_t i = 0; i < 3; ++i) {
    const double aside = (static_cast<double>(i) - 1.0) * std::sqrt(3.0) * damping;
    sum += CosineOfTurns(frequency_hz * (1.0 + aside) * time_s + UnitOf(words[i]));
  }
  return std::sqrt(2.0 / 3.0) * sum;
}

}  // namespace railcast
