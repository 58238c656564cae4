#include "core/io/recording/ring_table.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <span>

namespace railcast {
namespace {

/// Points closer than this are returns of the same firing.
constexpr double kMinStep_turns = 1e-5;
/// As above, as a share of the step, once the step is known.
constexpr double kSameFiringShare = 0.02;

/// Returns the usual azimuth step between neighbours of a row, or 0 if no row has neighbours.
/// @pre Sorted by row and azimuth.
double UsualStepOf(const std::vector<TablePoint>& points) {
  std::vector<double> steps;
  for (std::size_t i = 1; i < points.size(); ++i) {
    const double step = points[i].turns - points[i - 1].turns;
    if (points[i].row == points[i - 1].row && step > kMinStep_turns) steps.push_back(step);
  }
  if (steps.empty()) return 0.0;
  const auto quartile = steps.begin() + static_cast<std::ptrdiff_t>(steps.size() / 4);
  std::ranges::nth_element(steps, quartile);
  double usual = *quartile;
  // The quartile lies below the mean where steps vary, so the window's centre is moved to the mean.
  for (int pass = 0; pass < 5; ++pass) {
    double sum = 0.0;
    std::size_t num = 0;
    for (const double step : steps) {
      if (std::abs(step - usual) > 0.5 * usual) continue;
      sum += step;
      ++num;
    }
    if (num > 0) usual = sum / static_cast<double>(num);
  }
  return usual;
}

/// Refines the step over ever longer distances along the rings: each estimate is so exact that the
/// number of steps in the next distance is certain.
/// @pre Sorted by row and azimuth.
double RefineStep(const std::vector<TablePoint>& points, double step) {
  for (const double num_steps : {4.0, 16.0, 64.0, 256.0}) {
    double sum = 0.0;
    double num = 0.0;
    std::size_t far = 0;
    for (std::size_t i = 0; i < points.size(); ++i) {
      far = std::max(far, i);
      while (far < points.size() && points[far].row == points[i].row &&
             points[far].turns - points[i].turns < num_steps * step) {
        ++far;
      }
      if (far == points.size() || points[far].row != points[i].row) continue;
      const double way = points[far].turns - points[i].turns;
      if (way > 2.0 * num_steps * step) continue;
      sum += way;
      num += std::round(way / step);
    }
    if (num > 0.0) step = sum / num;
  }
  return step;
}

/// Returns the rising sequence nearest to `values` in the least-squares sense: neighbours that fall
/// are pooled (pool adjacent violators; Ayer et al. 1955, Ann. Math. Stat. 26).
std::vector<double> RisingFit(const std::vector<double>& values) {
  struct Pool {
    double sum{};
    std::size_t num{};
    [[nodiscard]] double mean() const { return sum / static_cast<double>(num); }
  };
  std::vector<Pool> pools;
  for (const double value : values) {
    pools.push_back({value, 1});
    while (pools.size() > 1 && pools[pools.size() - 2].mean() >= pools.back().mean()) {
      const Pool last = pools.back();
      pools.pop_back();
      pools.back().sum += last.sum;
      pools.back().num += last.num;
    }
  }
  std::vector<double> fit;
  for (const Pool& pool : pools) fit.insert(fit.end(), pool.num, pool.mean());
  return fit;
}

/// Returns the circular mean of the fractional parts, so that 0.99 and 1.01 average to 0.
double MeanFraction(const std::vector<double>& values) {
  double sine = 0.0;
  double cosine = 0.0;
  for (const double value : values) {
    sine += std::sin(2.0 * std::numbers::pi * value);
    cosine += std::cos(2.0 * std::numbers::pi * value);
  }
  return std::atan2(sine, cosine) / (2.0 * std::numbers::pi);
}

/// Assigns columns to the points of one ring.
/// @pre Sorted by azimuth.
void AssignRowColumns(std::span<TablePoint> ring, double step) {
  std::vector<std::size_t> firings;  // For each point, its firing.
  std::vector<double> places;        // For each firing, its unrounded column minus its number.
  for (std::size_t i = 0; i < ring.size(); ++i) {
    const bool is_same = i > 0 && ring[i].turns - ring[i - 1].turns < kSameFiringShare * step;
    if (!is_same) places.push_back(ring[i].turns / step - static_cast<double>(places.size()));
    firings.push_back(places.size() - 1);
  }
  const double fraction = MeanFraction(places);
  for (double& place : places) place -= fraction;
  const std::vector<double> fit = RisingFit(places);
  for (std::size_t i = 0; i < ring.size(); ++i) {
    ring[i].column = std::llround(fit[firings[i]]) + static_cast<std::int64_t>(firings[i]);
  }
}

}  // namespace

double AzimuthStepOf(const std::vector<TablePoint>& points) {
  const double usual = UsualStepOf(points);
  return usual > 0.0 ? RefineStep(points, usual) : 0.0;
}

void AssignColumns(std::vector<TablePoint>& points, double step) {
  for (std::size_t begin = 0; begin < points.size();) {
    std::size_t end = begin;
    while (end < points.size() && points[end].row == points[begin].row) ++end;
    AssignRowColumns(std::span(points).subspan(begin, end - begin), step);
    begin = end;
  }
}

}  // namespace railcast
