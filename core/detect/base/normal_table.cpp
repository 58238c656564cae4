#include "core/detect/base/normal_table.h"

#include <array>
#include <cstddef>

namespace railcast {
namespace {

constexpr int kCellsPerUnit = 64;
constexpr auto kNumCells = static_cast<std::size_t>(kNormalReach) * kCellsPerUnit;

struct Knot {
  double density{};
  double share{};  ///< Probability of [0, x].
};

/// e^x for 0 <= x <= 18: the Taylor series at x / 256, squared eight times.
constexpr double GrowthTo(double x) {
  const double small = x / 256.0;
  double term = 1.0;
  double sum = 1.0;
  for (int i = 1; i < 12; ++i) {
    term *= small / i;
    sum += term;
  }
  for (int i = 0; i < 8; ++i) sum *= sum;
  return sum;
}

/// Computes a knot; the share is density * (x + x^3 / 3 + x^5 / (3 5) + ...) (Abramowitz and Stegun
/// 26.2.11).
constexpr std::array<Knot, kNumCells + 1> MakeKnots() {
  constexpr double kDensityAtZero = 0.39894228040143267794;  // 1 / sqrt(2 pi)
  std::array<Knot, kNumCells + 1> knots{};
  for (std::size_t i = 0; i <= kNumCells; ++i) {
    const double x = static_cast<double>(i) / kCellsPerUnit;
    const double density = kDensityAtZero / GrowthTo(0.5 * x * x);
    double term = x;
    double sum = x;
    for (int odd = 3; term > 1e-17 * sum; odd += 2) {
      term *= x * x / odd;
      sum += term;
    }
    knots[i] = {density, density * sum};
  }
  return knots;
}

constexpr std::array<Knot, kNumCells + 1> kKnots = MakeKnots();

/// Position of x >= 0 between two knots: x = (cell + at) / kCellsPerUnit.
struct TablePlace {
  std::size_t cell{};
  double at{};
};

TablePlace TablePlaceOf(double x) {
  const double scaled = x * kCellsPerUnit;
  const auto cell = static_cast<std::size_t>(scaled);
  return {cell, scaled - static_cast<double>(cell)};
}

/// Cubic Hermite interpolation; the slopes are per cell.
double Interpolate(double begin, double begin_slope, double end, double end_slope, double at) {
  const double rest = 1.0 - at;
  return begin * (1.0 + 2.0 * at) * rest * rest + end * (3.0 - 2.0 * at) * at * at +
         begin_slope * at * rest * rest - end_slope * at * at * rest;
}

/// Probability of [0, x], an odd function of x.
double ShareFromZero(double x) {
  const double magnitude = x < 0.0 ? -x : x;
  double share = 0.5;
  if (magnitude < kNormalReach) {
    const auto [cell, at] = TablePlaceOf(magnitude);
    const Knot& begin = kKnots[cell];
    const Knot& end = kKnots[cell + 1];
    constexpr double kCell = 1.0 / kCellsPerUnit;
    share = Interpolate(begin.share, begin.density * kCell, end.share, end.density * kCell, at);
  }
  return x < 0.0 ? -share : share;
}

}  // namespace

double NormalDensity(double x) {
  const double magnitude = x < 0.0 ? -x : x;
  if (!(magnitude < kNormalReach)) return 0.0;
  const auto [cell, at] = TablePlaceOf(magnitude);
  const double begin = kKnots[cell].density;
  const double end = kKnots[cell + 1].density;
  constexpr double kCell = 1.0 / kCellsPerUnit;
  const double x_begin = static_cast<double>(cell) * kCell;
  return Interpolate(begin, -x_begin * begin * kCell, end, -(x_begin + kCell) * end * kCell, at);
}

double NormalShare(double a, double b) {
  return ShareFromZero(b) - ShareFromZero(a);
}

}  // namespace railcast
