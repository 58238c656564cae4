#include "analysis/frontier/frontier_report.h"

#include <algorithm>
#include <cmath>

#include "analysis/frontier/pareto.h"
#include "analysis/report/cell_text.h"
#include "analysis/report/chart_columns.h"
#include "analysis/report/formats.h"
#include "analysis/report/provenance.h"
#include "analysis/report/words.h"
#include "core/base/join.h"

namespace railcast {
namespace {

constexpr std::size_t kNumCharts = 4;
constexpr double kPercentOfAll = 100.0;

// All errors of all rows, in SI units or in units for readers.
Table ErrorsTable(const std::vector<RowResult>& results, bool is_si) {
  Table table = TableOf(kFrontierWords, "time_and_errors");
  for (const FrontierError& error : kFrontierErrors) {
    table.columns.push_back({is_si ? error.name : error.shown_name, error.title, error.unit});
  }
  for (const RowResult& result : results) {
    std::vector<Cell> row = {result.row.name, std::string(RowGroupName(result.row.group)),
                             result.p50_ms(), result.p99_ms(), result.ratio()};
    for (const FrontierError& error : kFrontierErrors) {
      const double value = result.difference ? error.of(*result.difference) : std::nan("");
      row.emplace_back(is_si ? value : error.scale * value);
    }
    table.rows.push_back(std::move(row));
  }
  return table;
}

Table FoundTable(const std::vector<RowResult>& results) {
  Table table = TableOf(kFrontierWords, "found");
  for (const RowResult& result : results) {
    if (!result.difference) continue;
    const FrameDifference& d = *result.difference;
    std::vector<Cell> row = {result.row.name, result.ratio()};
    for (const Matched& matched :
         {d.reference_echoes, d.echoes, d.thin, d.further, d.second, d.steps}) {
      row.emplace_back(Scaled(Proportion(matched.num_matched, matched.num), kPercentOfAll));
    }
    table.rows.push_back(std::move(row));
  }
  return table;
}

// The bins in which the reference has points.
void AddPoints(const std::string& row,
               const char* target,
               const TargetPoints& points,
               Table& table) {
  for (std::size_t i = 0; i < points.bins.size(); ++i) {
    const TargetPoints::Bin& bin = points.bins[i];
    if (bin.num_reference == 0) continue;
    const double from_m = static_cast<double>(TargetPoints::kBin_m) * static_cast<double>(i);
    table.rows.push_back({row, std::string(target), from_m, bin.num_reference, bin.num,
                          static_cast<double>(bin.num) / static_cast<double>(bin.num_reference)});
  }
}

Table TargetsTable(const std::vector<RowResult>& results) {
  Table table = TableOf(kFrontierWords, "targets");
  for (const RowResult& result : results) {
    if (!result.difference) continue;
    AddPoints(result.row.name, "persons", result.difference->persons, table);
    AddPoints(result.row.name, "poles", result.difference->poles, table);
  }
  return table;
}

Table ParetoTable(const std::vector<RowResult>& results) {
  Table table = TableOf(kFrontierWords, "pareto_fronts");
  for (const FrontierError& error : kFrontierErrors) {
    table.rows.push_back({std::string(error.title), Join(ParetoFront(results, error))});
  }
  return table;
}

// One group of rows, from fast to slow.
ChartSeries GroupSeries(const Table& errors,
                        const std::string& error,
                        RowGroup group,
                        const std::string& title) {
  const bool is_line = group != RowGroup::kBetween && group != RowGroup::kChosen;
  ChartSeries series = SeriesOf(
      errors, {"ratio_to_raw_trace", error, is_line ? "row" : "", "group", RowGroupName(group)},
      title, is_line ? SeriesStyle::kLinePoints : SeriesStyle::kPoints);
  std::ranges::stable_sort(series.points, {}, &ChartPoint::x);
  for (ChartPoint& point : series.points) {
    if (point.label == "surface+thin_conductors") point.label = "surface + wires";
    // Rows of brute force are labelled with their number of rays.
    if (group == RowGroup::kBruteForce) {
      point.label = point.label.substr(point.label.rfind('_') + 1);
    }
  }
  return series;
}

Chart ErrorChart(const Table& errors, const FrontierError& error) {
  const std::string key = error.shown_name;
  Chart chart = ChartOf(kFrontierWords, "error", {{"error", error.title}});
  chart.key = key;
  chart.y.unit = error.unit;
  chart.series = {GroupSeries(errors, key, RowGroup::kLadder, "railcast"),
                  GroupSeries(errors, key, RowGroup::kBruteForce, "brute force, rays a beam"),
                  GroupSeries(errors, key, RowGroup::kBetween, "footprint without thin_conductors"),
                  GroupSeries(errors, key, RowGroup::kChosen, "fidelity auto")};
  // Only rows that were run stand in the legend.
  std::erase_if(chart.series, [](const ChartSeries& series) { return series.points.empty(); });
  return chart;
}

Section TimeSection(const FrontierPlan& plan, const std::vector<RowResult>& results) {
  Section section = SectionOf(kFrontierWords, "frontier");
  const Table errors = ErrorsTable(results, false);
  for (std::size_t i = 0; i < kNumCharts; ++i) {
    section.charts.push_back(ErrorChart(errors, kFrontierErrors[i]));
  }
  section.paragraphs = {DefeatsText(results)};
  const std::string busy = BusyText(ConditionsOf(plan, results));
  if (!busy.empty()) section.paragraphs.insert(section.paragraphs.begin(), busy);
  section.tables = {errors, FoundTable(results), TargetsTable(results), ParetoTable(results)};
  return section;
}

std::string TitleOfRow(const FrontierPlan& plan, const std::string& scenario) {
  const auto counted = [](std::size_t num, const std::string& what) {
    return std::to_string(num) + " " + what + (num == 1 ? "" : "s");
  };
  return scenario + ": " + counted(plan.frames.size(), "frame") + ", " +
         (plan.num_threads == 0 ? "all threads"
                                : counted(static_cast<std::size_t>(plan.num_threads), "thread")) +
         ", errors against " + std::to_string(plan.yardstick_rays) + " sub-rays a beam";
}

}  // namespace

Report MakeFrontierReport(const FrontierPlan& plan,
                          const FrontierCircumstances& circumstances,
                          const LabelTable& labels,
                          const std::vector<RowResult>& results,
                          const std::string& command) {
  Report report{.title = TitleOfRow(plan, circumstances.scenario),
                .command = command,
                .facts = {{"Scenario", circumstances.scenario},
                          {"Scenario hash", circumstances.scenario_hash},
                          {"Weather", circumstances.weather},
                          {"Seed", std::to_string(circumstances.seed)},
                          {"Machine", ProcessorName()},
                          {"Version", Joined({"railcast ", circumstances.version})},
                          {"Date", circumstances.date}}};
  for (const RowResult& result : results) {
    if (result.row.group != RowGroup::kLadder) continue;
    report.headlines.push_back({result.row.name, "x raw", result.ratio()});
  }
  if (ConditionsOf(plan, results).is_busy()) report.title += ": busy machine, times not to be used";
  report.sections = {TimeSection(plan, results), PartsSection(results)};
  if (auto detail = DetailSection(plan, labels, results)) {
    report.sections.push_back(std::move(*detail));
  }
  report.sections.push_back(
      SectionOf(kFrontierWords, "fidelity_auto", {{"choice", circumstances.choice_text}}));
  return report;
}

std::string FrontierCsv(const std::vector<RowResult>& results) {
  return TableCsv(ErrorsTable(results, true));
}

}  // namespace railcast
