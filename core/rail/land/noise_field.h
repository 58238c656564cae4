#pragma once

#include <cstdint>

#include "core/base/random.h"

namespace railcast {

/// A smooth random height over the plane: value noise (Perlin 1985, "An image synthesizer", with
/// the quintic of Perlin 2002) on the integer lattice of (u, v). Mean 0 and, averaged over a
/// lattice cell, variance 1; bounded by 4.43. A function of its key and arguments alone, continuous
/// with its first and second derivatives.
class NoiseField {
 public:
  /// At the lattice points themselves the standard deviation is larger than the average.
  static constexpr double kLatticeSigma = 1.2763;

  /// `layer` tells apart fields of one use.
  NoiseField(std::uint64_t seed, RandomUse use, std::uint32_t layer)
      : seed_(seed), use_(use), layer_(layer) {}

  [[nodiscard]] double At(double u, double v) const;

 private:
  [[nodiscard]] double LatticeValue(std::int32_t i, std::int32_t j) const;

  std::uint64_t seed_;
  RandomUse use_;
  std::uint32_t layer_;
};

}  // namespace railcast
