#include <Eigen/Dense>
#include <algorithm>
#include <cmath>

#include "analysis/extras/preset/receiver_figures.h"

namespace railcast {
namespace {

/// A depth jump in a ring.
struct Jump {
  Vector3 row = Vector3::Zero();  ///< A row of the equations of least squares.
  double num_lost{};
  double size_m{};
  bool is_beyond_1m{};  ///< The near side.

  [[nodiscard]] bool IsInBand() const { return num_lost <= 1.0 && size_m >= 3.0 && size_m < 10.0; }
};
using Jumps = std::array<std::vector<Jump>, kNumSectors>;

void AddRow(const Frame& frame, const ScanTable& scan, std::size_t row, Jumps& jumps) {
  constexpr std::size_t kMostLost = 4;
  std::size_t before = frame.columns;
  double before_m = 0.0;
  for (std::size_t column = 0; column < frame.columns; ++column) {
    const std::size_t slot = row * frame.width() + column * frame.returns;
    std::size_t first = slot;
    while (first < slot + frame.returns && std::isnan(frame.range_m[first])) ++first;
    if (first == slot + frame.returns) continue;
    const auto range_m = static_cast<double>(frame.range_m[first]);
    if (before < column && column - before <= kMostLost + 1 && std::abs(range_m - before_m) > 1.0) {
      const auto [near_m, far_m] = std::minmax(range_m, before_m);
      const double steps = (1.0 / near_m - 1.0 / far_m) / scan.column_step_rad;
      jumps.at(SectorOf(scan, row, column))
          .push_back({.row = {1.0, steps, before_m < range_m ? 0.0 : steps},
                      .num_lost = static_cast<double>(column - before - 1),
                      .size_m = far_m - near_m,
                      .is_beyond_1m = near_m > 1.0});
    }
    before = column;
    before_m = range_m;
  }
}

/// A figure of the jumps that take part.
template <typename Takes, typename Of>
Estimate FigureOf(const Jumps& jumps, const Takes& takes, const Of& of) {
  std::vector<std::uint64_t> sizes;
  for (const auto& sector : jumps) {
    sizes.push_back(static_cast<std::uint64_t>(std::ranges::count_if(sector, takes)));
  }
  const auto without = [&](std::size_t left_out) {
    Eigen::Matrix3d normal = Eigen::Matrix3d::Zero();
    Vector3 right = Vector3::Zero();
    for (std::size_t i = 0; i < jumps.size(); ++i) {
      if (i == left_out) continue;
      for (const Jump& jump : jumps.at(i)) {
        if (!takes(jump)) continue;
        normal += jump.row * jump.row.transpose();
        right += jump.row * jump.num_lost;
      }
    }
    return of(normal, right);
  };
  return EstimateOf(Jackknife(without, sizes));
}

}  // namespace

JumpLosses FindJumpLosses(const GridTurns& turns) {
  Jumps jumps;
  for (std::size_t i = 0; i < turns.scans.size(); ++i) {
    for (std::size_t row = 0; row < turns.scans[i].rows; ++row) {
      AddRow(turns.frames[i]->frame, turns.scans[i], row, jumps);
    }
  }
  const auto fitted = [&](Eigen::Index which) {
    return FigureOf(
        jumps, [](const Jump& jump) { return jump.is_beyond_1m; },
        [which](const Eigen::Matrix3d& normal, const Vector3& right) {
          return normal.ldlt().solve(right)[which];
        });
  };
  return {.share = FigureOf(
              jumps, [](const Jump& jump) { return jump.IsInBand(); },
              [](const Eigen::Matrix3d& normal, const Vector3& right) {
                return right[0] / normal(0, 0);
              }),
          .base = fitted(0),
          .common_m = fitted(1),
          .aside_m = fitted(2)};
}

}  // namespace railcast
