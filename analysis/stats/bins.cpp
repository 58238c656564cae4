#include "analysis/stats/bins.h"

#include <algorithm>
#include <cmath>

#include "analysis/stats/sums.h"

namespace railcast {

Bins::Bins(std::vector<double> edges) : edges_(std::move(edges)) {}

std::optional<std::size_t> Bins::Find(double value) const {
  if (!(value >= edges_.front() && value < edges_.back())) return std::nullopt;
  const auto above = std::upper_bound(edges_.begin(), edges_.end(), value);
  return static_cast<std::size_t>(above - edges_.begin()) - 1;
}

const Bins& RangeBins() {
  static const Bins bins({0.0, 2.0, 5.0, 10.0, 15.0, 20.0, 30.0, 40.0, 50.0, 60.0, 80.0, 100.0,
                          125.0, 150.0, 200.0, 250.0, 300.0, 500.0});
  return bins;
}

const Bins& FineRangeBins() {
  static const Bins bins([] {
    constexpr int kBinsAnOctave = 4;
    constexpr int kOctaves = 9;
    std::vector<double> edges;
    for (int i = 0; i <= kBinsAnOctave * kOctaves; ++i) {
      edges.push_back(std::exp2(static_cast<double>(i) / kBinsAnOctave));
    }
    return edges;
  }());
  return bins;
}

const Bins& IncidenceBins() {
  static const Bins bins({0.0, 10.0, 20.0, 30.0, 40.0, 50.0, 60.0, 70.0, 80.0, 90.0});
  return bins;
}

ChartAxis DistanceAxis(const std::string& title) {
  ChartAxis axis{title, "m"};
  for (std::size_t i = 0; i < kNumDistanceBins; ++i) {
    const std::string from = i == 0 ? "0" : NumberText(kBinDistances_m.at(i - 1));
    axis.categories.push_back(
        i < kBinDistances_m.size() ? from + "-" + NumberText(kBinDistances_m.at(i)) : "> " + from);
  }
  return axis;
}

std::vector<TableColumn> DistanceColumns(const std::string& before, const std::string& end) {
  std::vector<TableColumn> columns = ColumnsOf(before);
  for (std::size_t i = 0; i < kNumDistanceBins; ++i) {
    std::string key = DistanceBinName(i) + end;
    std::ranges::replace(key, ' ', '_');
    columns.push_back({std::move(key), DistanceBinText(i), "m"});
  }
  return columns;
}

Cell GroupCell(GroupBy by, std::size_t group, const Names& names) {
  switch (by) {
    case GroupBy::kRange:
      return RangeBins().span(group);
    case GroupBy::kIncidence:
      return IncidenceBins().span(group);
    case GroupBy::kLabel:
      return names.OfLabel(static_cast<std::uint32_t>(group));
    case GroupBy::kMaterial:
      return names.OfMaterial(static_cast<std::uint16_t>(group));
    case GroupBy::kRing:
      break;
  }
  return std::to_string(group);
}

}  // namespace railcast
