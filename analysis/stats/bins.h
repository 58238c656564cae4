#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "analysis/report/report.h"
#include "core/io/run/dataset_files.h"

namespace railcast {

/// The words of statistics (report/words.h).
extern const char* const kStatsWords;

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

/// Numbers by bin of kBinDistances_m.
using RangeCounts = std::array<std::uint64_t, kNumDistanceBins>;

/// An axis of the bins of distance, with names that are short enough to stand below it: "10-25".
[[nodiscard]] ChartAxis DistanceAxis(const std::string& title);

/// A column for each bin of distance, "25_to_50" in m, after those of ColumnsOf(`before`).
/// @param end Of their keys.
[[nodiscard]] std::vector<TableColumn> DistanceColumns(const std::string& before,
                                                       const std::string& end = "");

/// A row with these numbers after what it is of.
template <typename Numbers>
[[nodiscard]] std::vector<Cell> RowOf(std::vector<Cell> row, const Numbers& numbers) {
  row.insert(row.end(), numbers.begin(), numbers.end());
  return row;
}

}  // namespace railcast
