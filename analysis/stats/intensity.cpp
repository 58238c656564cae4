#include "analysis/stats/intensity.h"

#include <cmath>
#include <numbers>

#include "analysis/report/chart_columns.h"
#include "analysis/stats/bins.h"

namespace railcast {
namespace {

using Sum = Intensity::Sum;

constexpr double kDegreesPerRad = 180.0 / std::numbers::pi;

/// Rows of a table: name and sums.
using NamedSums = std::vector<std::pair<Cell, const Sum*>>;

NamedSums IntensityInBins(const std::vector<Sum>& sums, const Bins& bins) {
  NamedSums named;
  for (std::size_t i = 0; i < sums.size(); ++i) {
    if (sums[i].plain.num() > 0) named.emplace_back(bins.span(i), &sums[i]);
  }
  return named;
}

Table IntensityTable(const char* key, const char* title, TableColumn first, const NamedSums& sums) {
  Table table = {
      key, title, "", {std::move(first), {"mean", "Mean", ""}, {"median", "Median", ""}}, {}};
  for (const auto& [name, sum] : sums) {
    table.rows.push_back({name, sum->plain.Mean(), sum->robust.Median()});
  }
  return table;
}

Chart MakeChart(const Table& table,
                const char* title,
                const std::string& caption,
                const ChartAxis& x) {
  const std::string& place = table.columns.front().key;
  return {table.key,
          title,
          caption,
          x,
          {"Intensity", ""},
          {SeriesOf(table, {place, "mean"}, "mean"), SeriesOf(table, {place, "median"}, "median")}};
}

}  // namespace

void Intensity::Sum::Add(double intensity) {
  plain.Add(intensity);
  robust.Add(intensity);
}

void Intensity::Sum::Add(const Sum& other) {
  plain.Add(other.plain);
  robust.Add(other.robust);
}

void Intensity::Add(const RecordedFrame& recorded, const std::vector<PlanePatch>& patches) {
  if (!recorded.Has("intensity")) return;
  const Frame& frame = recorded.frame;
  has_true_incidence_ = recorded.Has("incidence_rad");
  by_range_.resize(RangeBins().size());
  by_incidence_.resize(IncidenceBins().size());
  for (std::size_t slot = 0; slot < frame.num_slots(); ++slot) {
    if (!std::isfinite(frame.range_m[slot])) continue;
    const auto intensity = static_cast<double>(frame.intensity[slot]);
    all_.Add(intensity);
    const auto bin = RangeBins().Find(static_cast<double>(frame.range_m[slot]));
    if (bin) by_range_[*bin].Add(intensity);
    if (recorded.Has("label")) by_label_[frame.label[slot]].Add(intensity);
    if (!has_true_incidence_) continue;
    const double incidence_deg = kDegreesPerRad * static_cast<double>(frame.incidence_rad[slot]);
    if (const auto place = IncidenceBins().Find(incidence_deg))
      by_incidence_[*place].Add(intensity);
  }
  if (has_true_incidence_) return;
  for (const PlanePatch& patch : patches) {
    const auto bin = IncidenceBins().Find(kDegreesPerRad * patch.incidence_rad);
    if (bin) by_incidence_[*bin].Add(patch.intensity);
  }
}

void Intensity::Add(const Intensity& other) {
  has_true_incidence_ = has_true_incidence_ || other.has_true_incidence_;
  all_.Add(other.all_);
  AddEach(by_range_, other.by_range_);
  AddEach(by_incidence_, other.by_incidence_);
  for (const auto& [label, sum] : other.by_label_) by_label_[label].Add(sum);
}

Section Intensity::MakeSection(const Names& names) const {
  Section section{"intensity", "Intensity", {}, {}, {}};
  section.paragraphs.emplace_back(has_true_incidence_
                                      ? "Of points, as recorded; incidence is the truth's."
                                      : "Of points, as recorded. Incidence is that of flat pieces "
                                        "of surface: their samples are "
                                        "pieces, and none is met under 60 deg or more.");
  section.tables = {
      IntensityTable("intensity_by_range", "Intensity by range", {"range_m", "Range", "m"},
                     IntensityInBins(by_range_, RangeBins())),
      IntensityTable("intensity_by_incidence", "Intensity by incidence",
                     {"incidence_deg", "Incidence", "deg"},
                     IntensityInBins(by_incidence_, IncidenceBins()))};
  section.charts = {
      MakeChart(
          section.tables[0], "Intensity against range",
          "A level line is a sensor that makes up for range; a mean far above the median is few "
          "bright points.",
          {"Range", "m"}),
      MakeChart(section.tables[1], "Intensity against incidence",
                "A line that falls is matt surfaces, which return less the more they are slanted.",
                {"Incidence", "deg"})};
  if (!by_label_.empty()) {
    NamedSums labels;
    for (const auto& [label, sum] : by_label_) labels.emplace_back(names.OfLabel(label), &sum);
    section.tables.push_back(
        IntensityTable("intensity_by_label", "Intensity by label", {"label", "Label", ""}, labels));
  }
  return section;
}

}  // namespace railcast
