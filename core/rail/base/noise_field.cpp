#include "core/rail/base/noise_field.h"

#include <array>
#include <cmath>
#include <cstddef>
#include <optional>

namespace railcast {
namespace {

/// Rises from 0 to 1 with zero slope and zero curvature at either end.
double Quintic(double t) {
  return t * t * t * (t * (t * 6.0 - 15.0) + 10.0);
}

/// A lattice point of a field.
struct LatticePoint {
  std::uint64_t seed{};
  RandomUse use{};
  std::uint32_t layer{};
  std::int32_t i{};
  std::int32_t j{};
  bool operator==(const LatticePoint&) const = default;
};

double ValueAt(const LatticePoint& point) {
  const auto words = RandomWords(point.seed, point.use, static_cast<std::uint32_t>(point.i),
                                 static_cast<std::uint32_t>(point.j), point.layer);
  double sum = 0.0;
  for (const std::uint32_t word : words) sum += static_cast<double>(UnitFloat(word)) - 0.5;
  // The sum of four uniforms has variance 4/12. The quintic q has integral(q^2 + (1 - q)^2) =
  // 181/231, so interpolation in two directions leaves (181/231)^2 of the lattice's variance;
  // kLatticeSigma = 231/181 compensates for that.
  return NoiseField::kLatticeSigma * std::sqrt(3.0) * sum;
}

}  // namespace

double NoiseField::LatticeValue(std::int32_t i, std::int32_t j) const {
  // Places beside each other, as in a person's footprint, ask for the same points again.
  struct Known {
    LatticePoint point;
    std::optional<double> value;
  };
  constexpr std::size_t kNumKnown = 64;
  thread_local std::array<Known, kNumKnown> known_values{};
  const LatticePoint point{seed_, use_, layer_, i, j};
  Known& known = known_values[(static_cast<std::uint32_t>(i) + 8U * static_cast<std::uint32_t>(j) +
                               29U * layer_) %
                              kNumKnown];
  if (!known.value || known.point != point) known = {point, ValueAt(point)};
  return *known.value;
}

double NoiseField::At(double u, double v) const {
  const double i = std::floor(u);
  const double j = std::floor(v);
  const auto column = static_cast<std::int32_t>(i);
  const auto row = static_cast<std::int32_t>(j);
  const double along_u = Quintic(u - i);
  const double along_v = Quintic(v - j);
  const auto value_in_row = [&](std::int32_t lattice_row) {
    const double first = LatticeValue(column, lattice_row);
    if (along_u == 0.0) return first;
    return std::lerp(first, LatticeValue(column + 1, lattice_row), along_u);
  };
  const double first = value_in_row(row);
  return along_v == 0.0 ? first : std::lerp(first, value_in_row(row + 1), along_v);
}

}  // namespace railcast
