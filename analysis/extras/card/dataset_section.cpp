#include "analysis/estimate/estimate.h"
#include "analysis/extras/card/dataset_overview.h"

#include <algorithm>
#include <utility>
#include <vector>

#include "analysis/report/cell_text.h"
#include "analysis/report/chart_columns.h"
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

std::string OverviewText(const DatasetOverview& overview) {
  const char* const what =
      "Objects are counted in each frame whose sensor they are in range of, hidden or not; "
      "distances are those from the sensor to the middle of their boxes.";
  return Joined({Plural(overview.num_scenarios, "scenario"), ", ",
                 Plural(overview.report.num_frames, "frame"), ", ",
                 Plural(overview.report.counts.points, "point"), ". ", what});
}

Table FramesTable(const DatasetReportRecord& report) {
  Table table = {"dataset_frames",
                 "Repeated and empty frames",
                 "Duplicates: of frames with the same bytes, all but the first. Without objects: "
                 "no object has a point.",
                 ColumnsOf("frames: Frames; count: Number; share_percent: Share"),
                 {},
                 true};
  const auto add = [&](const char* name, std::uint64_t count) {
    table.rows.push_back({std::string(name), count, Percent(count, report.num_frames)});
  };
  add("duplicates", report.duplicate_frames);
  add("without points", report.frames_without_points);
  add("without objects", report.frames_without_objects);
  return table;
}

Table SplitTable(const DatasetReportRecord& report) {
  Table table = {"dataset_parts",
                 "Parts",
                 "",
                 ColumnsOf("part: Part; scenarios: Scenarios; frames: Frames; frames_percent: "
                           "Share of frames; points: Points; points_percent: Share of points"),
                 {},
                 true};
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
  Table table = {"dataset_classes", "Balance of classes",
                 "Frames: those with a point of the label.",
                 ColumnsOf("label: Label; points: Points; points_percent: Share of points; frames: "
                           "Frames; frames_percent: Share of frames")};
  const auto points_of = [](const auto& of) { return of.second.points; };
  for (const auto& [label, of] : GreatestFirst(report.labels, points_of)) {
    table.rows.push_back({label, of.points, Percent(of.points, report.counts.points), of.frames,
                          Percent(of.frames, report.num_frames)});
  }
  return table;
}

Table TypesTable(const std::vector<TypeCounts>& types) {
  Table table = {"dataset_objects",
                 "Objects by type",
                 "All but the first number count an object in each frame.",
                 ColumnsOf("type: Type; objects: Distinct; in_frames: In frames; with_points: With "
                           "points; with_points_percent: With points; points: Points"),
                 {},
                 true};
  for (const auto& [name, type] : types) {
    table.rows.push_back({name, type.objects, type.in_frames, type.with_points,
                          Percent(type.with_points, type.in_frames), type.points});
  }
  return table;
}

// A table of one row for each type and one column for each bin.
template <typename Counts>
Table BinsTable(Table table,
                const std::vector<TypeCounts>& types,
                Counts TypeCountsRecord::*counts) {
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
  // Numbers of persons and of anything else differ by orders of magnitude.
  Chart chart = {table.key,
                 table.title,
                 "Where a line is low or broken, the set shows few or none of that type",
                 std::move(x),
                 {"Objects, in each frame", "", true}};
  chart.series = SeriesByRow(table, kMostTypes);
  chart.caption.text +=
      table.rows.size() > kMostTypes ? "; only the types that are in the most frames." : ".";
  return chart;
}

void AddObjects(const DatasetReportRecord& report, Section& section) {
  const auto types =
      GreatestFirst(report.objects, [](const auto& type) { return type.second.in_frames; });
  section.tables.push_back(TypesTable(types));
  Table distances = BinsTable(
      {"dataset_objects_by_distance", "Objects by distance", "", DistanceColumns("type: Type")},
      types, &TypeCountsRecord::by_distance);
  section.charts.push_back(BinsChart(distances, DistanceAxis("Distance")));
  section.tables.push_back(std::move(distances));
  section.tables.push_back(BinsTable({"dataset_points_by_distance", "Points on objects by distance",
                                      "", DistanceColumns("type: Type")},
                                     types, &TypeCountsRecord::points_by_distance));
  Table occlusions =
      BinsTable({"dataset_objects_by_occlusion", "Objects by occlusion",
                 "Occlusion: the share of the firings onto the object that something else stops. "
                 "Not visible: no firing would meet it even alone.",
                 OcclusionColumns()},
                types, &TypeCountsRecord::by_occlusion);
  section.charts.push_back(BinsChart(
      occlusions,
      {"Occlusion", "", false, {"< 0.25", "0.25-0.5", "0.5-0.75", "0.75-1", "1", "not visible"}}));
  section.tables.push_back(std::move(occlusions));
}

// A table of numbers by name, with their shares of their sum.
Table CountsTable(Table table, const CountsByName& counts) {
  std::uint64_t sum = 0;
  for (const auto& [name, count] : counts) sum += count;
  for (const auto& [name, count] : counts) {
    table.rows.push_back({name, count, Percent(count, sum)});
  }
  return table;
}

void AddOrigins(const DatasetReportRecord& report, Section& section) {
  Table weathers = CountsTable(
      {"dataset_weathers", "Weathers",
       "Rain and snow: any that falls; fog: visibility up to 1,000 m; dry: none of these.",
       ColumnsOf("weather: Weather; scenarios: Scenarios; share_percent: Share")},
      report.weathers);
  section.charts.push_back(
      {weathers.key,
       weathers.title,
       "A short bar is a weather that the set hardly has.",
       {"", "", false, TextsOf(weathers, "weather")},
       {"Scenarios", ""},
       {SeriesOf(weathers, {"weather", "scenarios"}, "", SeriesStyle::kBars)}});
  section.tables.push_back(std::move(weathers));
  Table words = {
      "dataset_drawn", "Words drawn",
      "The options of the recipe's groups, and its draws of words, by the number of scenarios.",
      ColumnsOf("draw: Draw; word: Word; scenarios: Scenarios; share_percent: Share")};
  for (const auto& [draw, counts] : report.drawn) {
    for (std::vector<Cell>& row : CountsTable({}, counts).rows) {
      row.insert(row.begin(), draw);
      words.rows.push_back(std::move(row));
    }
  }
  if (!words.rows.empty()) section.tables.push_back(std::move(words));
  section.tables.push_back(CountsTable(
      {"dataset_bases", "Bases", "", ColumnsOf("base: Base; frames: Frames; share_percent: Share")},
      report.frames_by_base));
  section.tables.push_back(
      CountsTable({"dataset_sensors", "Sensors", "",
                   ColumnsOf("sensor: Sensor; frames: Frames; share_percent: Share")},
                  report.frames_by_sensor));
}

}  // namespace

Section MakeDatasetSection(const DatasetOverview& overview, const std::string& suffix) {
  Section section{"dataset", "Data set " + ShownPath(overview.source), {OverviewText(overview)}};
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
