#pragma once

#include <cstdint>

#include "core/base/random.h"

namespace railcast {

/// A smooth random height over the plane: value noise (Perlin 1985, "An image synthesizer", with
/// the quintic of Perlin 2002) on the integer lattice of (u, v). It has mean 0 and, averaged over a
/// lattice cell, variance 1, and is bounded by 4.43. It depends on its key and arguments only and
/// has continuous first and second derivatives.
class NoiseField {
 public:
  /// Standard deviation at the lattice points, which is larger than the average.
  static constexpr double kLatticeSigma = 1.2763;

  /// @param layer Distinguishes fields of the same use.
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
