#include <algorithm>
#include <functional>

#include "analysis/compare/compare_report.h"
#include "analysis/report/cell_text.h"
#include "analysis/report/words.h"
#include "analysis/stats/bins.h"
#include "analysis/stats/names.h"
#include "core/detect/detector/effect_table.h"

namespace railcast {
namespace {

constexpr double kPercent = 100.0;
// More lines than this in one chart cannot be told apart.
constexpr std::size_t kMaxLines = 7;

std::string NameOf(const EffectStudy& study) {
  if (study.rung) return Joined({InWords(study.effect), " (on ", NameOf(*study.rung), ")"});
  return Joined({InWords(study.effect), study.is_in_scenario ? "" : " (switched on)"});
}

std::string WhereStudied(const EffectStudy& study) {
  if (study.rung) return "on " + std::string(NameOf(*study.rung));
  return study.is_in_scenario ? "on" : "off";
}

std::uint64_t NumChanged(const EffectStudy& study) {
  return study.beams.num_beams - study.beams.num_identical;
}

std::uint64_t NumOutcomeChanged(const EffectStudy& study) {
  return study.beams.num_outcome_changed;
}

// Sorts by the given number, largest first.
std::vector<const EffectStudy*> Sorted(
    const std::vector<EffectStudy>& studies,
    const std::function<std::uint64_t(const EffectStudy&)>& num) {
  std::vector<const EffectStudy*> sorted;
  for (const EffectStudy& study : studies) sorted.push_back(&study);
  std::stable_sort(sorted.begin(), sorted.end(),
                   [&](const EffectStudy* a, const EffectStudy* b) { return num(*a) > num(*b); });
  return sorted;
}

Chart ChangedChart(const std::vector<const EffectStudy*>& studies) {
  Table bars{.columns = ColumnsOf("effect: Effect; anything: Anything; outcome: Outcome")};
  for (const EffectStudy* const study : studies) {
    const BeamChanges& beams = study->beams;
    bars.rows.push_back({NameOf(*study), PercentProportion(NumChanged(*study), beams.num_beams),
                         PercentProportion(beams.num_outcome_changed, beams.num_beams)});
  }
  return ChartOfTable(kCompareWords, "changed_beams", bars);
}

Chart ReturnsChart(const std::vector<const EffectStudy*>& studies) {
  Table bars{.columns = ColumnsOf("effect: Effect; removed: Taken away; added: Added")};
  for (const EffectStudy* const study : studies) {
    const BeamChanges& beams = study->beams;
    const std::uint64_t num_without = beams.num_both + beams.num_removed;
    bars.rows.push_back({NameOf(*study), Percent(beams.num_removed, num_without),
                         Percent(beams.num_added, num_without)});
  }
  return ChartOfTable(kCompareWords, "returns", bars);
}

Table EffectsTable(const std::vector<EffectStudy>& studies) {
  Table table = TableOf(kCompareWords, "effects");
  for (const EffectStudy& study : studies) {
    const BeamChanges& beams = study.beams;
    constexpr double kShare = 0.95;
    table.rows.push_back(
        {study.effect, WhereStudied(study), beams.num_beams,
         PercentProportion(beams.num_identical, beams.num_beams),
         PercentProportion(beams.num_outcome_changed, beams.num_beams), beams.num_removed,
         beams.num_added, PercentProportion(beams.num_moved, beams.num_both),
         beams.moved_m.Median(), beams.moved_m.Quantile(kShare),
         PercentProportion(beams.num_intensity_changed, beams.num_both),
         beams.intensity_change.Median(), beams.intensity_change.Quantile(kShare)});
  }
  return table;
}

// What a mean over frames does not show: one frame may change and all others stay.
Table FrameToFrameTable(const std::vector<EffectStudy>& studies) {
  Table table = TableOf(kCompareWords, "frames");
  for (const EffectStudy& study : studies) {
    std::vector<Cell> row = {study.effect, study.frames.size()};
    for (const auto share : {&FrameChanges::outcome, &FrameChanges::points}) {
      std::vector<double> percents;
      for (const FrameChanges& frame : study.frames) percents.push_back(kPercent * frame.*share);
      const auto [least, most] = std::ranges::minmax(percents);
      row.insert(row.end(), {least, Median(percents), most});
    }
    table.rows.push_back(std::move(row));
  }
  return table;
}

Section EffectsSection(const std::vector<EffectStudy>& studies) {
  std::string rest;
  for (const std::string& name : EffectNames()) {
    const auto is_it = [&](const EffectStudy& study) { return study.effect == name; };
    if (std::ranges::any_of(studies, is_it)) continue;
    rest += (rest.empty() ? "" : ", ") + InWords(name);
  }
  Section section = SectionOf(kCompareWords, "effects", {{"rest", rest}});
  const std::vector<const EffectStudy*> sorted = Sorted(studies, NumChanged);
  section.charts = {ChangedChart(sorted), ReturnsChart(sorted)};
  section.tables = {EffectsTable(studies), FrameToFrameTable(studies)};
  return section;
}

// Charts only the effects that change most.
Chart RangeChart(const std::vector<EffectStudy>& studies,
                 const std::string& key,
                 std::uint64_t BeamChanges::RangeBin::*num_changed) {
  std::vector<ChartSeries> lines;
  const auto sum = [&](const EffectStudy& study) {
    std::uint64_t num = 0;
    for (const BeamChanges::RangeBin& bin : study.beams.range_bins) num += bin.*num_changed;
    return num;
  };
  for (const EffectStudy* const study : Sorted(studies, sum)) {
    if (sum(*study) == 0 || lines.size() == kMaxLines) break;
    ChartSeries series{NameOf(*study), SeriesStyle::kLinePoints};
    for (std::size_t bin = 0; bin < RangeBins().size(); ++bin) {
      const BeamChanges::RangeBin& counts = study->beams.range_bins[bin];
      if (counts.num_beams == 0) continue;
      series.points.push_back(PointAt(RangeBins().middle(bin),
                                      PercentProportion(counts.*num_changed, counts.num_beams)));
    }
    lines.push_back(std::move(series));
  }
  Chart chart = ChartOf(kCompareWords, key, {{"seven", lines.size() == kMaxLines}});
  chart.series = std::move(lines);
  return chart;
}

Section RangeSection(const std::vector<EffectStudy>& studies) {
  Section section = SectionOf(kCompareWords, "by_range");
  section.charts = {
      RangeChart(studies, "outcome_by_range", &BeamChanges::RangeBin::num_outcome_changed),
      RangeChart(studies, "changed_by_range", &BeamChanges::RangeBin::num_changed)};
  Table table = TableOf(kCompareWords, "changed_by_range");
  for (const EffectStudy& study : studies) {
    table.columns.push_back({study.effect + "_percent", InWords(study.effect), "%"});
  }
  for (std::size_t bin = 0; bin < RangeBins().size(); ++bin) {
    std::vector<Cell> row = {RangeBins().span(bin)};
    for (const EffectStudy& study : studies) {
      const BeamChanges::RangeBin& counts = study.beams.range_bins[bin];
      row.emplace_back(PercentProportion(counts.num_changed, counts.num_beams));
    }
    table.rows.push_back(std::move(row));
  }
  section.tables = {std::move(table)};
  return section;
}

// How many more beams have each outcome with the effect than without it.
Table OutcomesTable(const std::vector<EffectStudy>& studies) {
  Table table = TableOf(kCompareWords, "outcomes");
  for (const std::string_view name : kOutcomeNames) {
    table.columns.push_back({std::string(name), InWords(name), ""});
  }
  for (const EffectStudy& study : studies) {
    std::vector<Cell> row = {study.effect};
    for (std::size_t outcome = 0; outcome < BeamChanges::kNumOutcomes; ++outcome) {
      double change = 0.0;
      for (std::size_t other = 0; other < BeamChanges::kNumOutcomes; ++other) {
        change += static_cast<double>(study.beams.transitions[other][outcome]);
        change -= static_cast<double>(study.beams.transitions[outcome][other]);
      }
      row.emplace_back(change);
    }
    table.rows.push_back(std::move(row));
  }
  return table;
}

Table TransitionsTable(const std::vector<EffectStudy>& studies) {
  Table table = TableOf(kCompareWords, "transitions");
  for (const EffectStudy& study : studies) {
    for (std::size_t from = 0; from < BeamChanges::kNumOutcomes; ++from) {
      const auto& row = study.beams.transitions[from];
      std::uint64_t num_from = 0;
      for (const std::uint64_t num : row) num_from += num;
      for (std::size_t to = 0; to < BeamChanges::kNumOutcomes; ++to) {
        if (from == to || row[to] == 0) continue;
        table.rows.push_back({study.effect, InWords(kOutcomeNames[from]),
                              InWords(kOutcomeNames[to]), row[to],
                              PercentProportion(row[to], num_from)});
      }
    }
  }
  return table;
}

Section OutcomesSection(const std::vector<EffectStudy>& studies) {
  Section section = SectionOf(kCompareWords, "outcomes");
  section.tables = {OutcomesTable(studies), TransitionsTable(studies)};
  return section;
}

Chart CloudChart(const std::vector<EffectStudy>& studies, const std::string& metric) {
  Table bars{.columns = ColumnsOf("effect: Effect; mean: Mean")};
  for (const EffectStudy* const study : Sorted(studies, NumChanged)) {
    bars.rows.push_back({NameOf(*study), MeanOverPairs(study->clouds, metric)});
  }
  return ChartOfTable(kCompareWords, metric, bars);
}

Section CloudsSection(const std::vector<EffectStudy>& studies) {
  Section section = SectionOf(kCompareWords, "clouds", {{"metrics", MetricsInWords()}});
  section.charts = {CloudChart(studies, "chamfer_m"), CloudChart(studies, "density_aware_chamfer")};
  Table table = TableOf(kCompareWords, "clouds");
  if (!studies.empty()) {
    std::ranges::copy(studies.front().clouds.metrics(), std::back_inserter(table.columns));
  }
  for (const EffectStudy& study : studies) {
    std::vector<Cell> row = {study.effect};
    for (const TableColumn& metric : study.clouds.metrics()) {
      row.push_back(MeanOverPairs(study.clouds, metric.key));
    }
    table.rows.push_back(std::move(row));
  }
  section.tables = {std::move(table)};
  return section;
}

}  // namespace

Report MakeAblationReport(const std::vector<EffectStudy>& studies,
                          const std::string& title,
                          const std::vector<std::pair<std::string, std::string>>& facts,
                          const std::string& command) {
  Report report{.title = title, .command = command, .facts = facts};
  constexpr std::size_t kMaxHeadlines = 6;
  for (const EffectStudy* const study : Sorted(studies, NumOutcomeChanged)) {
    if (NumOutcomeChanged(*study) == 0 || report.headlines.size() == kMaxHeadlines) break;
    report.headlines.push_back(
        {Joined({"Beams with another outcome by ", NameOf(*study)}), "%",
         PercentProportion(study->beams.num_outcome_changed, study->beams.num_beams)});
  }
  report.sections = {EffectsSection(studies), RangeSection(studies), OutcomesSection(studies),
                     CloudsSection(studies)};
  return report;
}

}  // namespace railcast
