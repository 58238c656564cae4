#include "analysis/stats/statistics.h"

#include <algorithm>

#include "analysis/report/chart_columns.h"
#include "analysis/report/words.h"
#include "analysis/stats/bins.h"
#include "core/base/units.h"
#include "core/io/recording/firing_truth.h"

namespace railcast {
namespace {

using Count = Dropout::Count;

// Reasons why a surface that was met yields no point.
constexpr Outcome kCauses[] = {Outcome::kOutOfRange,    Outcome::kBelowThreshold,
                               Outcome::kRainAbsorbed,  Outcome::kNearRange,
                               Outcome::kSensorDropout, Outcome::kCoverBlocked};

Table GroupTable(const Grouped<Count>& counts, GroupBy by, const Names& names, const char* what) {
  Table table = TableOf(kStatsWords, std::string("dropout_by_") + what);
  std::vector<Outcome> causes;
  for (const Outcome cause : kCauses) {
    if (std::ranges::none_of(counts.Of(by),
                             [&](const auto& group) { return group.second.of(cause) > 0; })) {
      continue;
    }
    causes.push_back(cause);
    table.columns.push_back(
        {std::string(OutcomeName(cause)) + "_percent", InWords(OutcomeName(cause)), "%"});
  }
  counts.ForEach(by, names, [&](const Cell& name, const Count& count) {
    std::vector<Cell>& row = table.rows.emplace_back(
        std::vector<Cell>{name, count.num, PercentProportion(count.num_lost(), count.num)});
    for (const Outcome cause : causes) {
      row.emplace_back(PercentProportion(count.of(cause), count.num));
    }
  });
  return table;
}

// Dropout by range for all causes together and for each.
Chart DropoutChart(const Table& table) {
  Chart chart = ChartOf(kStatsWords, table.key);
  for (std::size_t i = 2; i < table.columns.size(); ++i) {
    const TableColumn& column = table.columns[i];
    chart.series.push_back(SeriesOf(table, {"true_range_m", column.key},
                                    column.key == "dropout_percent" ? "all causes" : column.title));
  }
  return chart;
}

Chart LabelChart(const Table& table) {
  return ChartOfTable(kStatsWords, table.key, table);
}

}  // namespace

void Dropout::Add(const RecordedFrame& recorded) {
  if (!HasOutcomes(recorded)) return;
  const Frame& frame = recorded.frame;
  for (std::size_t slot = 0; slot < frame.num_slots(); slot += frame.returns) {
    const Outcome outcome = frame.outcome[slot];
    all_.Add(outcome);
    if (!KnowsSurface(frame, slot)) continue;
    surface_.Add(outcome);
    const double incidence_deg = DegFromRad(static_cast<double>(frame.incidence_rad[slot]));
    groups_.Add(GroupBy::kRing, slot / frame.width(), outcome);
    groups_.Add(GroupBy::kRange, RangeBins().Find(static_cast<double>(frame.true_range_m[slot])),
                outcome);
    groups_.Add(GroupBy::kIncidence, IncidenceBins().Find(incidence_deg), outcome);
    if (recorded.Has("label")) groups_.Add(GroupBy::kLabel, frame.label[slot], outcome);
    if (recorded.Has("material")) groups_.Add(GroupBy::kMaterial, frame.material[slot], outcome);
  }
}

Estimate Dropout::Share() const {
  return Proportion(surface_.num_lost(), surface_.num);
}

Section Dropout::MakeSection(const Names& names) const {
  Section section = SectionOf(kStatsWords, "dropout");

  Table outcomes = TableOf(kStatsWords, "outcomes");
  for (std::size_t i = 0; i < kOutcomeNames.size(); ++i) {
    const std::uint64_t num = all_.outcomes[i];
    if (num == 0) continue;
    outcomes.rows.push_back({InWords(kOutcomeNames[i]), num, PercentProportion(num, all_.num)});
  }
  section.tables.push_back(std::move(outcomes));

  const auto add = [&](const char* what, GroupBy by, Chart (*chart_of)(const Table&) = nullptr) {
    if (groups_.Of(by).empty()) return;
    Table table = GroupTable(groups_, by, names, what);
    if (chart_of != nullptr) section.charts.push_back(chart_of(table));
    section.tables.push_back(std::move(table));
  };
  add("range", GroupBy::kRange, DropoutChart);
  add("incidence", GroupBy::kIncidence);
  add("label", GroupBy::kLabel, LabelChart);
  add("material", GroupBy::kMaterial);
  add("ring", GroupBy::kRing);
  return section;
}

}  // namespace railcast
