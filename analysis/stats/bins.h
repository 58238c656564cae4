#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "analysis/report/report.h"
#include "core/io/run/dataset_files.h"

namespace railcast {

/// Half-open bins between rising edges.
class Bins {
 public:
  explicit Bins(std::vector<double> edges);

  [[nodiscard]] std::size_t size() const { return edges_.size() - 1; }
  /// Returns nothing for NaN and for values outside the edges.
  [[nodiscard]] std::optional<std::size_t> Find(double value) const;
  [[nodiscard]] double middle(std::size_t bin) const {
    return 0.5 * (edges_[bin] + edges_[bin + 1]);
  }
  [[nodiscard]] Span span(std::size_t bin) const { return {edges_[bin], edges_[bin + 1]}; }

 private:
  std::vector<double> edges_;
};

/// Bins of the tables, in metres: narrow near the sensor, where most points are.
[[nodiscard]] const Bins& RangeBins();
/// Bins for power-law fits, in metres: four per octave.
[[nodiscard]] const Bins& FineRangeBins();
/// Bins of incidence in degrees, 10 wide.
[[nodiscard]] const Bins& IncidenceBins();

/// An axis of the bins of distance, with names that are short enough to stand below it: "10-25".
[[nodiscard]] inline ChartAxis DistanceAxis(const std::string& title) {
  ChartAxis axis{title, "m"};
  for (std::size_t i = 0; i < kNumDistanceBins; ++i) {
    const std::string from = i == 0 ? "0" : NumberText(kBinDistances_m.at(i - 1));
    axis.categories.push_back(
        i < kBinDistances_m.size() ? from + "-" + NumberText(kBinDistances_m.at(i)) : "> " + from);
  }
  return axis;
}

/// Adds each element of `others` to its counterpart; `sums` grows to the larger size.
template <typename Sum>
void AddEach(std::vector<Sum>& sums, const std::vector<Sum>& others) {
  if (sums.size() < others.size()) sums.resize(others.size());
  for (std::size_t i = 0; i < others.size(); ++i) sums[i].Add(others[i]);
}

}  // namespace railcast
