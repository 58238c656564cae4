#include "analysis/stats/statistics.h"

#include "analysis/report/chart_columns.h"
#include "analysis/report/words.h"
#include "analysis/stats/bins.h"
#include "core/base/units.h"

namespace railcast {
namespace {

Table IntensityTable(const Grouped<Scatter>& groups,
                     GroupBy by,
                     const Names& names,
                     const char* what) {
  Table table = TableOf(kStatsWords, std::string("intensity_by_") + what);
  groups.ForEach(by, names, [&](const Cell& name, const Scatter& sum) {
    // A bin of points without intensity is empty, a label is not.
    if (sum.num() == 0 && by != GroupBy::kLabel) return;
    table.rows.push_back({name, sum.plain.Mean(), sum.robust.Median()});
  });
  return table;
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
  Section section =
      SectionOf(kStatsWords, "intensity", {{"has_true_incidence", has_true_incidence_}});
  section.tables = {IntensityTable(groups_, GroupBy::kRange, names, "range"),
                    IntensityTable(groups_, GroupBy::kIncidence, names, "incidence")};
  section.charts = {ChartOfTable(kStatsWords, "intensity_by_range", section.tables[0]),
                    ChartOfTable(kStatsWords, "intensity_by_incidence", section.tables[1])};
  if (!groups_.Of(GroupBy::kLabel).empty()) {
    section.tables.push_back(IntensityTable(groups_, GroupBy::kLabel, names, "label"));
  }
  return section;
}

}  // namespace railcast
