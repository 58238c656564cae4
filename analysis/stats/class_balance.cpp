#include "analysis/stats/class_balance.h"
#include "analysis/estimate/estimate.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>

#include "analysis/report/cell_text.h"
#include "analysis/report/chart_columns.h"
#include "analysis/stats/bins.h"

namespace railcast {
namespace {

using RangeCounts = std::array<std::uint64_t, kNumDistanceBins>;

void AddCounts(const RangeCounts& counts, RangeCounts& sums) {
  std::ranges::transform(counts, sums, sums.begin(), std::plus());
}

// A column for each bin of range.
void AddRangeColumns(const std::string& end, Table& table) {
  table.columns = {{"label", "Label", ""}};
  for (std::size_t i = 0; i < kNumDistanceBins; ++i) {
    std::string key = DistanceBinName(i) + end;
    std::ranges::replace(key, ' ', '_');
    table.columns.push_back({std::move(key), DistanceBinText(i), "m"});
  }
}

Chart LabelsChart(const Table& labels,
                  const std::string& column,
                  const std::string& title,
                  const std::string& caption,
                  const ChartAxis& y) {
  return {"label_" + column,
          title,
          caption,
          {"", "", false, TextsOf(labels, "label")},
          y,
          {SeriesOf(labels, {"label", column}, "", SeriesStyle::kBars)}};
}

// Of the labels with most points; more lines would hide each other.
Chart SharesChart(const Table& shares) {
  constexpr std::size_t kMostLabels = 7;
  Chart chart = {"shares_by_label_and_range",
                 "Share of points by label against range",
                 "The highest line is the class with most of the points at that range; only the "
                 "labels with most "
                 "points.",
                 DistanceAxis("Range"),
                 {"Share", "%", true},
                 {}};
  chart.series = SeriesByRow(shares, kMostLabels);
  return chart;
}

}  // namespace

std::uint64_t ClassBalance::Class::num_points() const {
  return std::accumulate(by_range.begin(), by_range.end(), std::uint64_t{0});
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
    AddCounts(by_range, sum.by_range);
    sum.points.Add(
        static_cast<double>(std::accumulate(by_range.begin(), by_range.end(), std::uint64_t{0})));
  }
}

void ClassBalance::Add(const ClassBalance& other) {
  num_frames_ += other.num_frames_;
  for (const auto& [label, others] : other.classes_) {
    Class& sum = classes_[label];
    sum.points.Add(others.points);
    AddCounts(others.by_range, sum.by_range);
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
  Table table = {"points_by_label",
                 "Points by label",
                 "Frames: those with a point of the label, which the mean is over.",
                 {{"label", "Label", ""},
                  {"points", "Points", ""},
                  {"points_percent", "Share of points", "%"},
                  {"frames", "Frames", ""},
                  {"frames_percent", "Share of frames", "%"},
                  {"points_per_frame", "Points a frame", ""}},
                 {},
                 true};
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
  Section section{"classes", "Balance of classes", {}, {}, {}};
  Table labels = LabelsTable(names);
  Table counts = {"points_by_label_and_range", "Points by label and range", "", {}, {}};
  Table shares = {"shares_by_label_and_range",
                  "Shares by label and range, in percent",
                  "Of all points in the range.",
                  {},
                  {}};
  AddRangeColumns("", counts);
  AddRangeColumns("_percent", shares);
  RangeCounts totals{};
  for (const auto& [label, of] : classes_) AddCounts(of.by_range, totals);
  const auto add_row = [&](const std::string& name, const RangeCounts& by_range) {
    std::vector<Cell> numbers = {name}, percents = {name};
    for (std::size_t i = 0; i < by_range.size(); ++i) {
      numbers.emplace_back(by_range[i]);
      percents.emplace_back(Percent(by_range[i], totals[i]));
    }
    counts.rows.push_back(std::move(numbers));
    shares.rows.push_back(std::move(percents));
  };
  for (const auto& [label, of] : Sorted()) add_row(names.OfLabel(label), of->by_range);
  section.charts = {// The labels' points differ by orders of magnitude.
                    LabelsChart(labels, "points_percent", "Points by label",
                                "The shortest bars are the classes that a detector sees least of.",
                                {"Share of points", "%", true}),
                    LabelsChart(labels, "frames_percent", "Frames with a point of each label",
                                "A short bar is a class that most frames do not show at all.",
                                {"Share of frames", "%"}),
                    SharesChart(shares)};
  add_row("all", totals);
  const std::uint64_t total = std::accumulate(totals.begin(), totals.end(), std::uint64_t{0});
  section.paragraphs.push_back(Joined({CountText(total), " points in ", CountText(num_frames_),
                                       " frames with labels. Ranges are the measured ones."}));
  section.tables = {std::move(labels), std::move(counts), std::move(shares)};
  return section;
}

}  // namespace railcast
