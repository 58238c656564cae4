#include "analysis/estimate/estimate.h"
#include "analysis/extras/card/dataset_overview.h"

#include <algorithm>
#include <utility>
#include <vector>

#include "analysis/report/cell_text.h"
#include "analysis/report/chart_columns.h"
#include "analysis/report/words.h"
#include "analysis/stats/bins.h"
#include "core/base/text.h"

namespace railcast {
namespace {

using TypeCounts = std::pair<std::string, TypeCountsRecord>;

// More series in one chart would hide each other; the tables have them all.
constexpr std::size_t kMostTypes = 6;

std::string Plural(std::uint64_t count, const std::string& noun) {
  return Joined({CountText(count), " ", noun, count == 1 ? "" : "s"});
}

// The entries of a map, those with the greatest values first.
template <typename Counts, typename Value>
auto GreatestFirst(const Counts& by_name, const Value& value_of) {
  std::vector<std::pair<std::string, typename Counts::mapped_type>> entries(by_name.begin(),
                                                                            by_name.end());
  std::ranges::stable_sort(entries, std::greater(), value_of);
  return entries;
}

Table FramesTable(const DatasetReportRecord& report) {
  Table table = TableOf(kCardWords, "dataset_frames");
  const auto add = [&](const char* name, std::uint64_t count) {
    table.rows.push_back({std::string(name), count, Percent(count, report.num_frames)});
  };
  add("duplicates", report.duplicate_frames);
  add("without points", report.frames_without_points);
  add("without objects", report.frames_without_objects);
  return table;
}

Table SplitTable(const DatasetReportRecord& report) {
  Table table = TableOf(kCardWords, "dataset_parts");
  // Validation comes before the test, not after it as in the alphabet.
  const auto parts = GreatestFirst(report.splits, [](const auto& part) {
    return std::pair(part.first == "train", part.first == "val");
  });
  for (const auto& [name, part] : parts) {
    table.rows.push_back({name, part.scenarios, part.frames,
                          Percent(part.frames, report.num_frames), part.points,
                          Percent(part.points, report.counts.points)});
  }
  return table;
}

Table ClassesTable(const DatasetReportRecord& report) {
  Table table = TableOf(kCardWords, "dataset_classes");
  const auto points_of = [](const auto& of) { return of.second.points; };
  for (const auto& [label, of] : GreatestFirst(report.labels, points_of)) {
    table.rows.push_back({label, of.points, Percent(of.points, report.counts.points), of.frames,
                          Percent(of.frames, report.num_frames)});
  }
  return table;
}

Table TypesTable(const std::vector<TypeCounts>& types) {
  Table table = TableOf(kCardWords, "dataset_objects");
  for (const auto& [name, type] : types) {
    table.rows.push_back({name, type.objects, type.in_frames, type.with_points,
                          Percent(type.with_points, type.in_frames), type.points});
  }
  return table;
}

// A table of one row for each type and one column for each bin.
template <typename Counts>
Table BinsTable(const char* key,
                std::vector<TableColumn> columns,
                const std::vector<TypeCounts>& types,
                Counts TypeCountsRecord::*counts) {
  Table table = TableOf(kCardWords, key);
  table.columns = std::move(columns);
  for (const auto& [name, type] : types) table.rows.push_back(RowOf({name}, type.*counts));
  return table;
}

// "less than 0.25" has the key "less_than_0.25".
std::vector<TableColumn> OcclusionColumns() {
  std::vector<TableColumn> columns = ColumnsOf("type: Type");
  for (const std::string_view name : kOcclusionBinNames) {
    columns.push_back({std::string(name), std::string(name)});
    std::ranges::replace(columns.back().key, ' ', '_');
  }
  return columns;
}

// A line for each of the types that are in most frames, over the bins of such a table.
Chart BinsChart(const Table& table, ChartAxis x) {
  Chart chart = ChartOf(kCardWords, "dataset_bins",
                        {{"title", table.title}, {"is_part", table.rows.size() > kMostTypes}});
  chart.key = table.key;
  chart.x = std::move(x);
  chart.series = SeriesByRow(table, kMostTypes);
  return chart;
}

void AddObjects(const DatasetReportRecord& report, Section& section) {
  const auto types =
      GreatestFirst(report.objects, [](const auto& type) { return type.second.in_frames; });
  section.tables.push_back(TypesTable(types));
  Table distances = BinsTable("dataset_objects_by_distance", DistanceColumns("type: Type"), types,
                              &TypeCountsRecord::by_distance);
  section.charts.push_back(BinsChart(distances, DistanceAxis("Distance")));
  section.tables.push_back(std::move(distances));
  section.tables.push_back(BinsTable("dataset_points_by_distance", DistanceColumns("type: Type"),
                                     types, &TypeCountsRecord::points_by_distance));
  Table occlusions = BinsTable("dataset_objects_by_occlusion", OcclusionColumns(), types,
                               &TypeCountsRecord::by_occlusion);
  section.charts.push_back(BinsChart(
      occlusions,
      {"Occlusion", "", false, {"< 0.25", "0.25-0.5", "0.5-0.75", "0.75-1", "1", "not visible"}}));
  section.tables.push_back(std::move(occlusions));
}

// Rows of numbers by name, with their shares of their sum.
std::vector<std::vector<Cell>> RowsOf(const CountsByName& counts) {
  std::uint64_t sum = 0;
  for (const auto& [name, count] : counts) sum += count;
  std::vector<std::vector<Cell>> rows;
  for (const auto& [name, count] : counts) rows.push_back({name, count, Percent(count, sum)});
  return rows;
}

Table CountsTable(const char* key, const CountsByName& counts) {
  Table table = TableOf(kCardWords, key);
  table.rows = RowsOf(counts);
  return table;
}

void AddOrigins(const DatasetReportRecord& report, Section& section) {
  Table weathers = CountsTable("dataset_weathers", report.weathers);
  section.charts.push_back(ChartOfTable(kCardWords, "dataset_weathers", weathers));
  section.tables.push_back(std::move(weathers));
  Table words = TableOf(kCardWords, "dataset_drawn");
  for (const auto& [draw, counts] : report.drawn) {
    for (std::vector<Cell>& row : RowsOf(counts)) {
      row.insert(row.begin(), draw);
      words.rows.push_back(std::move(row));
    }
  }
  if (!words.rows.empty()) section.tables.push_back(std::move(words));
  section.tables.push_back(CountsTable("dataset_bases", report.frames_by_base));
  section.tables.push_back(CountsTable("dataset_sensors", report.frames_by_sensor));
}

}  // namespace

Section MakeDatasetSection(const DatasetOverview& overview, const std::string& suffix) {
  Section section = SectionOf(kCardWords, "dataset",
                              {{"source", ShownPath(overview.source)},
                               {"scenarios", Plural(overview.num_scenarios, "scenario")},
                               {"frames", Plural(overview.report.num_frames, "frame")},
                               {"points", Plural(overview.report.counts.points, "point")}});
  section.tables = {SplitTable(overview.report), FramesTable(overview.report)};
  if (!overview.report.objects.empty()) AddObjects(overview.report, section);
  section.tables.push_back(ClassesTable(overview.report));
  AddOrigins(overview.report, section);
  section.key += suffix;
  for (Chart& chart : section.charts) chart.key += suffix;
  for (Table& table : section.tables) table.key += suffix;
  return section;
}

}  // namespace railcast
