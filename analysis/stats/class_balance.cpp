#include "analysis/stats/statistics.h"

#include <algorithm>
#include <numeric>

#include "analysis/report/cell_text.h"
#include "analysis/report/chart_columns.h"
#include "analysis/report/words.h"
#include "analysis/stats/bins.h"

namespace railcast {
namespace {

std::uint64_t TotalOf(const RangeCounts& counts) {
  return std::accumulate(counts.begin(), counts.end(), std::uint64_t{0});
}

// A chart of the labels with most points; more lines would hide each other.
Chart SharesChart(const Table& shares) {
  constexpr std::size_t kMostLabels = 7;
  Chart chart = ChartOf(kStatsWords, "shares_by_label_and_range");
  chart.x = DistanceAxis("Range");
  chart.series = SeriesByRow(shares, kMostLabels);
  return chart;
}

}  // namespace

std::uint64_t ClassBalance::Class::num_points() const {
  return TotalOf(by_range);
}

void ClassBalance::Add(const RecordedFrame& recorded) {
  if (!recorded.Has("label")) return;
  ++num_frames_;
  const Frame& frame = recorded.frame;
  std::map<std::uint32_t, RangeCounts> counts;
  for (std::size_t slot = 0; slot < frame.num_slots(); ++slot) {
    if (!std::isfinite(frame.range_m[slot])) continue;
    ++counts[frame.label[slot]][BinOf(kBinDistances_m, static_cast<double>(frame.range_m[slot]))];
  }
  for (const auto& [label, by_range] : counts) {
    Class& sum = classes_[label];
    AddTo(sum.by_range, by_range);
    sum.points.Add(static_cast<double>(TotalOf(by_range)));
  }
}

std::vector<std::pair<std::uint32_t, const ClassBalance::Class*>> ClassBalance::Sorted() const {
  std::vector<std::pair<std::uint32_t, const Class*>> sorted;
  for (const auto& [label, of] : classes_) sorted.emplace_back(label, &of);
  std::ranges::stable_sort(sorted, std::greater(),
                           [](const auto& of) { return of.second->num_points(); });
  return sorted;
}

Table ClassBalance::LabelsTable(const Names& names) const {
  Table table = TableOf(kStatsWords, "points_by_label");
  std::uint64_t total = 0;
  for (const auto& [label, of] : classes_) total += of.num_points();
  for (const auto& [label, of] : Sorted()) {
    table.rows.push_back({names.OfLabel(label), of->num_points(), Percent(of->num_points(), total),
                          of->points.num(), Percent(of->points.num(), num_frames_),
                          of->points.Mean()});
  }
  return table;
}

Section ClassBalance::MakeSection(const Names& names) const {
  Table labels = LabelsTable(names);
  Table counts = TableOf(kStatsWords, "points_by_label_and_range");
  counts.columns = DistanceColumns("label: Label");
  Table shares = TableOf(kStatsWords, "shares_by_label_and_range");
  shares.columns = DistanceColumns("label: Label", "_percent");
  RangeCounts totals{};
  for (const auto& [label, of] : classes_) AddTo(totals, of.by_range);
  const auto add_row = [&](const std::string& name, const RangeCounts& by_range) {
    counts.rows.push_back(RowOf({name}, by_range));
    shares.rows.push_back({name});
    for (std::size_t i = 0; i < by_range.size(); ++i) {
      shares.rows.back().emplace_back(Percent(by_range[i], totals[i]));
    }
  };
  for (const auto& [label, of] : Sorted()) add_row(names.OfLabel(label), of->by_range);
  Section section =
      SectionOf(kStatsWords, "classes",
                {{"totals", CountText(TotalOf(totals))}, {"num_frames", CountText(num_frames_)}});
  section.charts = {ChartOfTable(kStatsWords, "label_points_percent", labels),
                    ChartOfTable(kStatsWords, "label_frames_percent", labels), SharesChart(shares)};
  add_row("all", totals);
  section.tables = {std::move(labels), std::move(counts), std::move(shares)};
  return section;
}

}  // namespace railcast
