#include "core/detect/beam/puddles.h"

#include <cmath>
#include <limits>
#include <numbers>

#include "core/base/random.h"
#include "core/detect/base/vector_math.h"

namespace railcast {
namespace {

// The value that a standard normal deviate exceeds with this probability, by bisection.
double UpperQuantile(double probability) {
  if (probability <= 0.0) return std::numeric_limits<double>::infinity();
  if (probability >= 1.0) return -std::numeric_limits<double>::infinity();
  double low = -40.0;
  double high = 40.0;
  for (int i = 0; i < 60; ++i) {
    const double middle = 0.5 * (low + high);
    const double above = 0.5 * std::erfc(middle / std::numbers::sqrt2);
    (above > probability ? low : high) = middle;
  }
  return low;
}

}  // namespace

Puddles::Puddles(std::uint64_t seed, double share)
    : least_(static_cast<float>(UpperQuantile(share))) {
  for (std::size_t i = 0; i < kNumPuddleWaves; ++i) {
    const auto words = RandomWords(seed, RandomUse::kPuddles, 0, static_cast<std::uint32_t>(i));
    const double azimuth_rad = 2.0 * std::numbers::pi * static_cast<double>(UnitFloat(words[0]));
    const double step = static_cast<double>(i) / static_cast<double>(kNumPuddleWaves - 1);
    const double wavelength_m = kShortest_m * std::pow(kLongest_m / kShortest_m, step);
    waves_[i] = {Vector3(std::cos(azimuth_rad), std::sin(azimuth_rad), 0.0) / wavelength_m,
                 static_cast<double>(UnitFloat(words[1]))};
  }
}

PuddleWaves Puddles::WavesAt(const Transform& world_from_window) const {
  PuddleWaves waves;
  waves.least = least_;
  for (std::size_t i = 0; i < kNumPuddleWaves; ++i) {
    const Vector3 here = world_from_window.linear().transpose() * waves_[i].turns_per_m;
    waves.x[i] = static_cast<float>(here.x());
    waves.y[i] = static_cast<float>(here.y());
    waves.z[i] = static_cast<float>(here.z());
    // World coordinates are large: only the fraction of a turn fits into float32.
    const double phase =
        waves_[i].turns_per_m.dot(world_from_window.translation()) + waves_[i].phase_turns;
    waves.phase[i] = static_cast<float>(phase - std::floor(phase));
  }
  return waves;
}

bool IsUnderWater(const PuddleWaves& waves, const float (&place_m)[3]) {
  constexpr float kAmplitude = 0.35355339F;  // sqrt(2 / 16)
  constexpr float kRounder = 12582912.0F;    // Adding and subtracting it rounds to an integer.
  float sum = 0.0F;
  for (std::size_t i = 0; i < kNumPuddleWaves; ++i) {
    const float turns = waves.x[i] * place_m[0] + waves.y[i] * place_m[1] +
                        waves.z[i] * place_m[2] + waves.phase[i];
    float cosine{};
    float sine{};
    baseline::CosSinTurn(turns - ((turns + kRounder) - kRounder), cosine, sine);
    sum += kAmplitude * cosine;
  }
  return sum > waves.least;
}

}  // namespace railcast
