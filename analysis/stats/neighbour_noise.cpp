#include "analysis/stats/neighbour_noise.h"

#include <cmath>

#include "analysis/report/words.h"
#include "analysis/stats/bins.h"
#include "core/io/recording/surface_point.h"

namespace railcast {

std::optional<double> SecondDifference_m(const RecordedFrame& recorded,
                                         std::size_t row,
                                         std::size_t column) {
  constexpr double kMost_m = 0.3;
  const Frame& frame = recorded.frame;
  if (column == 0 || column + 1 >= frame.columns) return std::nullopt;
  const std::size_t middle = row * frame.width() + column * frame.returns;
  for (const std::size_t slot : {middle - frame.returns, middle, middle + frame.returns}) {
    if (!HasSurfacePoint(recorded, slot)) return std::nullopt;
  }
  const auto range_m = [&](std::size_t slot) { return static_cast<double>(frame.range_m[slot]); };
  const double before_m = range_m(middle - frame.returns);
  const double after_m = range_m(middle + frame.returns);
  const double bend_m = before_m - 2.0 * range_m(middle) + after_m;
  const bool is_surface =
      std::abs(0.5 * bend_m) < kMost_m && std::abs(0.5 * (after_m - before_m)) < kMost_m;
  if (!is_surface) return std::nullopt;
  return bend_m / std::sqrt(6.0);
}

void NeighbourNoise::Add(const RecordedFrame& recorded) {
  if (!recorded.is_grid) return;
  const Frame& frame = recorded.frame;
  bins_.resize(RangeBins().size());
  for (std::size_t row = 0; row < frame.rows; ++row) {
    for (std::size_t column = 1; column + 1 < frame.columns; ++column) {
      const auto difference_m = SecondDifference_m(recorded, row, column);
      if (!difference_m) continue;
      const std::size_t slot = row * frame.width() + column * frame.returns;
      const auto bin = RangeBins().Find(static_cast<double>(frame.range_m[slot]));
      if (bin) bins_[*bin].Add(*difference_m);
    }
  }
}

Estimate NeighbourNoise::Sigma_m(std::size_t bin) const {
  // Correlations of -2/3 and 1/6 with the next and the one after it: 1 + 2 (4/9 + 1/36) = 1.94.
  const Scatter& differences_m = bins_[bin];
  return RobustScaleEstimate(differences_m.robust.RobustScale().value, differences_m.num() / 2);
}

Table NeighbourNoise::MakeTable() const {
  constexpr double kMm = 1e3;
  Table table = TableOf(kStatsWords, "noise_from_neighbours");
  for (std::size_t i = 0; i < bins_.size(); ++i) {
    if (bins_[i].num() == 0) continue;
    table.rows.push_back({RangeBins().span(i), bins_[i].num(), Scaled(Sigma_m(i), kMm)});
  }
  return table;
}

}  // namespace railcast
