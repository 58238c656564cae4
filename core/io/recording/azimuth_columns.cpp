#include "core/io/recording/ring_table.h"

#include <algorithm>
#include <cmath>
#include <complex>
#include <functional>
#include <numbers>
#include <span>

namespace railcast {
namespace {

/// Points closer than this are returns of the same firing.
constexpr double kMinStep_turns = 1e-5;
/// The same limit as a share of the step, once the step is known.
constexpr double kSameFiringShare = 0.02;
/// Steps that differ by no more than this share are alike.
constexpr double kAlike = 0.1;
/// The columns' step must be that of rows with this share of the points.
constexpr double kLeastShare = 0.05;
constexpr double kMostFirings = 4.0;
/// A row that fires several times within a column has more than this share of its neighbours one
/// step apart. Two lasers of one elevation that are taken for one ring have half of them, since a
/// short and a long step take turns.
constexpr double kLeastUsual = 0.6;
/// The share of neighbours, up to kFarthest_steps apart, that must lie within a quarter of a step
/// of a whole number of them. Of azimuths without any grid it is a half, and 86 % where each is off
/// by up to a fifth of a step.
constexpr double kLeastWholeShare = 0.75;
constexpr double kFarthest_steps = 4.5;
/// With fewer gaps than this, nothing follows from how they follow each other.
constexpr std::size_t kLeastGaps = 20;

/// Returns the usual step of one row, or 0 if it has no neighbours.
/// @pre Sorted by azimuth.
double UsualStepOf(std::span<const TablePoint> row) {
  std::vector<double> steps;
  for (std::size_t i = 1; i < row.size(); ++i) {
    const double step = row[i].turns - row[i - 1].turns;
    if (step > kMinStep_turns) steps.push_back(step);
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

/// The usual step of a row.
struct RowStep {
  std::uint32_t row{};
  double step{};
  double num_points{};
  double share_usual{};  ///< Share of the neighbours that are about one such step apart.
};

double ShareUsual(std::span<const TablePoint> row, double usual) {
  double num = 0.0;
  double num_usual = 0.0;
  for (std::size_t i = 1; i < row.size(); ++i) {
    const double step = row[i].turns - row[i - 1].turns;
    if (step <= kMinStep_turns) continue;
    num += 1.0;
    if (std::abs(step / usual - 1.0) < 0.25) num_usual += 1.0;
  }
  return num_usual / num;
}

/// Returns the longest step that enough points have, as the mean of the rows that are alike.
double ColumnStepOf(std::vector<RowStep> rows, std::size_t num_points) {
  std::ranges::sort(rows, std::greater(), &RowStep::step);
  for (const RowStep& longest : rows) {
    double sum = 0.0;
    double num = 0.0;
    for (const RowStep& row : rows) {
      if (std::abs(row.step / longest.step - 1.0) > kAlike) continue;
      sum += row.num_points * row.step;
      num += row.num_points;
    }
    if (num >= kLeastShare * static_cast<double>(num_points)) return sum / num;
  }
  return 0.0;
}

std::uint32_t FiringsWithin(double column, const RowStep& row) {
  const double ratio = column / row.step;
  const double whole = std::round(ratio);
  const bool is_whole = std::abs(ratio / whole - 1.0) <= kAlike && whole <= kMostFirings;
  return is_whole && row.share_usual > kLeastUsual ? static_cast<std::uint32_t>(whole) : 1;
}

/// Refines the columns' step over ever longer distances along the rings: each estimate is so exact
/// that the number of steps in the next distance is certain.
/// @pre Sorted by row and azimuth.
void RefineStep(const std::vector<TablePoint>& points, AzimuthSteps& steps) {
  for (const double num_steps : {4.0, 16.0, 64.0, 256.0}) {
    double sum = 0.0;
    double num = 0.0;
    std::size_t far = 0;
    for (std::size_t i = 0; i < points.size(); ++i) {
      const double step = steps.OfRow(points[i].row);
      far = std::max(far, i);
      while (far < points.size() && points[far].row == points[i].row &&
             points[far].turns - points[i].turns < num_steps * step) {
        ++far;
      }
      if (far == points.size() || points[far].row != points[i].row) continue;
      const double way = points[far].turns - points[i].turns;
      if (way > 2.0 * num_steps * step) continue;
      sum += way;
      num += std::round(way / step) / steps.firings[points[i].row];
    }
    if (num > 0.0) steps.column = sum / num;
  }
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

AzimuthSteps AzimuthStepsOf(const std::vector<TablePoint>& points, std::size_t num_rows) {
  std::vector<RowStep> rows;
  ForEachRow(points, [&](std::span<const TablePoint> row) {
    const double step = UsualStepOf(row);
    if (step <= 0.0) return;
    rows.push_back({row.front().row, step, static_cast<double>(row.size()), ShareUsual(row, step)});
  });
  AzimuthSteps steps{.column = ColumnStepOf(rows, points.size()),
                     .firings = std::vector<std::uint32_t>(num_rows, 1)};
  if (steps.column <= 0.0) return steps;
  for (const RowStep& row : rows) steps.firings[row.row] = FiringsWithin(steps.column, row);
  RefineStep(points, steps);
  return steps;
}

void RemoveParallax(std::vector<TablePoint>& points, const AzimuthSteps& steps, double outwards_m) {
  constexpr double kTurn_rad = 2.0 * std::numbers::pi;
  constexpr int kParts = 60;
  ForEachRow(points, [&](std::span<TablePoint> row) {
    const double step = steps.OfRow(row.front().row);
    const auto turned = [&](const TablePoint& point, double aside_m) {
      // No beam that begins beside the axis ends so near to it.
      if (point.from_axis_m <= outwards_m) return point.turns;
      return point.turns + aside_m / (kTurn_rad * point.from_axis_m);
    };
    double best_m = 0.0;
    double most = 0.0;
    for (int part = -kParts; part <= kParts; ++part) {
      const double aside_m = outwards_m * part / kParts;
      std::complex<double> sum;
      for (std::size_t i = 0; i < row.size(); i += 1 + row.size() / 500) {
        sum += std::polar(1.0, kTurn_rad * turned(row[i], aside_m) / step);
      }
      if (std::abs(sum) <= most) continue;
      most = std::abs(sum);
      best_m = aside_m;
    }
    for (TablePoint& point : row) point.turns = turned(point, best_m);
  });
}

void AssignColumns(std::vector<TablePoint>& points, const AzimuthSteps& steps) {
  ForEachRow(points, [&](std::span<TablePoint> row) {
    AssignRowColumns(row, steps.OfRow(row.front().row));
  });
}

bool AreFiringsCertain(const std::vector<TablePoint>& points, const AzimuthSteps& steps) {
  double num_near = 0.0;
  double num_whole = 0.0;
  std::size_t num_gaps = 0;
  std::size_t num_in_a_row = 0;
  ForEachRow(points, [&](std::span<const TablePoint> row) {
    const double step = steps.OfRow(row.front().row);
    bool follows_gap = false;
    for (std::size_t i = 1; i < row.size(); ++i) {
      const std::int64_t way = row[i].column - row[i - 1].column;
      if (way == 0) continue;
      const double way_steps = (row[i].turns - row[i - 1].turns) / step;
      if (way_steps < kFarthest_steps) {
        num_near += 1.0;
        if (std::abs(way_steps - std::round(way_steps)) < 0.25) num_whole += 1.0;
      }
      const bool is_gap = way == 2;
      num_gaps += is_gap ? 1 : 0;
      num_in_a_row += is_gap && follows_gap ? 1 : 0;
      follows_gap = is_gap;
    }
  });
  return num_whole >= kLeastWholeShare * num_near &&
         (num_gaps < kLeastGaps || 2 * num_in_a_row <= num_gaps);
}

}  // namespace railcast
