#pragma once

#include <array>
#include <cmath>
#include <cstdint>
#include <numbers>

#include "core/base/random.h"
#include "railcast/transform.h"

namespace railcast {

inline constexpr double kTurn_rad = 2.0 * std::numbers::pi;

/// Sequence of random numbers for the shape of one plant.
class PlantDice {
 public:
  PlantDice(std::uint64_t seed, std::uint32_t plant) : seed_(seed), plant_(plant) {}

  double Uniform(double low, double high) {
    if (next_ % 4 == 0) words_ = RandomWords(seed_, RandomUse::kPlantShape, plant_, next_ / 4);
    return low + (high - low) * static_cast<double>(UnitFloat(words_[next_++ % 4]));
  }
  /// Uniform on the unit sphere (by Archimedes' theorem).
  Vector3 Direction() {
    const double z = Uniform(-1.0, 1.0);
    const double azimuth_rad = Uniform(0.0, kTurn_rad);
    const double sine = std::sqrt(1.0 - z * z);
    return {sine * std::cos(azimuth_rad), sine * std::sin(azimuth_rad), z};
  }
  /// Random vector within a ball, denser towards its centre.
  Vector3 Offset(double radius_m) { return Uniform(0.0, radius_m) * Direction(); }

 private:
  std::uint64_t seed_;
  std::uint32_t plant_;
  std::uint32_t next_ = 0;
  std::array<std::uint32_t, 4> words_{};
};

}  // namespace railcast
