#include "analysis/stats/statistics.h"

#include "analysis/report/chart_columns.h"
#include "analysis/stats/bins.h"
#include "core/base/units.h"

namespace railcast {
namespace {

// @param what "range", in keys and titles.
// @param column The first one.
Table IntensityTable(const Grouped<Scatter>& groups,
                     GroupBy by,
                     const Names& names,
                     const std::string& what,
                     const std::string& column) {
  Table table = {"intensity_by_" + what, "Intensity by " + what, "",
                 ColumnsOf(column + "; mean: Mean; median: Median")};
  groups.ForEach(by, names, [&](const Cell& name, const Scatter& sum) {
    // A bin of points without intensity is empty, a label is not.
    if (sum.num() == 0 && by != GroupBy::kLabel) return;
    table.rows.push_back({name, sum.plain.Mean(), sum.robust.Median()});
  });
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

void Intensity::Add(const RecordedFrame& recorded, const std::vector<PlanePatch>& patches) {
  if (!recorded.Has("intensity")) return;
  const Frame& frame = recorded.frame;
  has_true_incidence_ = recorded.Has("incidence_rad");
  const auto add_incidence = [&](double incidence_rad, double intensity) {
    groups_.Add(GroupBy::kIncidence, IncidenceBins().Find(DegFromRad(incidence_rad)), intensity);
  };
  for (std::size_t slot = 0; slot < frame.num_slots(); ++slot) {
    if (!std::isfinite(frame.range_m[slot])) continue;
    const auto intensity = static_cast<double>(frame.intensity[slot]);
    all_.Add(intensity);
    groups_.Add(GroupBy::kRange, RangeBins().Find(static_cast<double>(frame.range_m[slot])),
                intensity);
    if (recorded.Has("label")) groups_.Add(GroupBy::kLabel, frame.label[slot], intensity);
    if (!has_true_incidence_) continue;
    add_incidence(static_cast<double>(frame.incidence_rad[slot]), intensity);
  }
  if (has_true_incidence_) return;
  for (const PlanePatch& patch : patches) add_incidence(patch.incidence_rad, patch.intensity);
}

Section Intensity::MakeSection(const Names& names) const {
  Section section{"intensity", "Intensity"};
  section.paragraphs.emplace_back(
      has_true_incidence_ ? "Of points, as recorded; incidence is the truth's."
                          : "Of points, as recorded. Incidence is that of flat pieces of surface: "
                            "their samples are pieces, and none is met under 60 deg or more.");
  section.tables = {
      IntensityTable(groups_, GroupBy::kRange, names, "range", "range_m: Range"),
      IntensityTable(groups_, GroupBy::kIncidence, names, "incidence", "incidence_deg: Incidence")};
  section.charts = {
      MakeChart(section.tables[0], "Intensity against range",
                "A level line is a sensor that makes up for range; a mean far above the median is "
                "few bright points.",
                {"Range", "m"}),
      MakeChart(section.tables[1], "Intensity against incidence",
                "A line that falls is matt surfaces, which return less the more they are slanted.",
                {"Incidence", "deg"})};
  if (!groups_.Of(GroupBy::kLabel).empty()) {
    section.tables.push_back(
        IntensityTable(groups_, GroupBy::kLabel, names, "label", "label: Label"));
  }
  return section;
}

}  // namespace railcast
