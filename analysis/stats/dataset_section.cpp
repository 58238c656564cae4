#include "analysis/estimate/estimate.h"
#include "analysis/stats/dataset_overview.h"

#include <algorithm>
#include <string_view>
#include <utility>
#include <vector>

#include "analysis/report/cell_text.h"
#include "analysis/report/chart_columns.h"
#include "analysis/stats/bins.h"
#include "core/base/text.h"

namespace railcast {
namespace {

using Counts = DatasetOverview::Counts;
using TypeCounts = DatasetOverview::TypeCounts;

// More series in one chart would hide each other; the tables have them all.
constexpr std::size_t kMostTypes = 6;

std::string Plural(std::uint64_t count, const std::string& noun) {
  return Joined({CountText(count), " ", noun, count == 1 ? "" : "s"});
}

std::string OverviewText(const DatasetOverview& overview) {
  const char* const what =
      "Objects are counted in each frame whose sensor they are in range of, hidden or not; "
      "distances are those from the sensor to the middle of their boxes.";
  return Joined({Plural(overview.num_scenarios, "scenario"), ", ",
                 Plural(overview.num_frames, "frame"), ", ", Plural(overview.num_points, "point"),
                 ". ", what});
}

Table FramesTable(const DatasetOverview& overview) {
  Table table = {
      "dataset_frames",
      "Repeated and empty frames",
      "Duplicates: of frames with the same bytes, all but the first. Without objects: no "
      "object has a point.",
      {{"frames", "Frames", ""}, {"count", "Number", ""}, {"share_percent", "Share", "%"}},
      {},
      true};
  const auto add = [&](const char* name, std::uint64_t count) {
    table.rows.push_back({std::string(name), count, Percent(count, overview.num_frames)});
  };
  add("duplicates", overview.duplicate_frames);
  add("without points", overview.frames_without_points);
  add("without objects", overview.frames_without_objects);
  return table;
}

Table SplitTable(const DatasetOverview& overview) {
  Table table = {"dataset_parts",
                 "Parts",
                 "",
                 {{"part", "Part", ""},
                  {"scenarios", "Scenarios", ""},
                  {"frames", "Frames", ""},
                  {"frames_percent", "Share of frames", "%"},
                  {"points", "Points", ""},
                  {"points_percent", "Share of points", "%"}},
                 {},
                 true};
  std::vector<DatasetOverview::Part> parts = overview.parts;
  // Validation comes before the test, not after it as in the alphabet.
  std::ranges::stable_sort(parts, std::greater(), [](const auto& part) {
    return std::pair(part.name == "train", part.name == "val");
  });
  for (const DatasetOverview::Part& part : parts) {
    table.rows.push_back({part.name, part.scenarios, part.frames,
                          Percent(part.frames, overview.num_frames), part.points,
                          Percent(part.points, overview.num_points)});
  }
  return table;
}

Table ClassesTable(const DatasetOverview& overview) {
  Table table = {"dataset_classes",
                 "Balance of classes",
                 "Frames: those with a point of the label.",
                 {{"label", "Label", ""},
                  {"points", "Points", ""},
                  {"points_percent", "Share of points", "%"},
                  {"frames", "Frames", ""},
                  {"frames_percent", "Share of frames", "%"}},
                 {}};
  std::vector<DatasetOverview::Class> classes = overview.classes;
  std::ranges::stable_sort(classes, std::greater(), &DatasetOverview::Class::points);
  for (const DatasetOverview::Class& of : classes) {
    table.rows.push_back({of.label, of.points, Percent(of.points, overview.num_points), of.frames,
                          Percent(of.frames, overview.num_frames)});
  }
  return table;
}

Table TypesTable(const std::vector<TypeCounts>& types) {
  Table table = {"dataset_objects",
                 "Objects by type",
                 "All but the first number count an object in each frame.",
                 {{"type", "Type", ""},
                  {"objects", "Distinct", ""},
                  {"in_frames", "In frames", ""},
                  {"with_points", "With points", ""},
                  {"with_points_percent", "With points", "%"},
                  {"points", "Points", ""}},
                 {},
                 true};
  for (const TypeCounts& type : types) {
    table.rows.push_back({type.name, type.objects, type.in_frames, type.with_points,
                          Percent(type.with_points, type.in_frames), type.points});
  }
  return table;
}

// A table of one row for each type and one column for each bin.
template <std::size_t kCount, typename ColumnOf>
Table BinsTable(Table table,
                const std::vector<TypeCounts>& types,
                std::array<std::uint64_t, kCount> TypeCounts::*counts,
                const ColumnOf& column_of) {
  table.columns.push_back({"type", "Type", ""});
  for (std::size_t i = 0; i < kCount; ++i) table.columns.push_back(column_of(i));
  for (const TypeCounts& type : types) {
    std::vector<Cell> row = {type.name};
    for (const std::uint64_t count : type.*counts) row.emplace_back(count);
    table.rows.push_back(std::move(row));
  }
  return table;
}

// "less than 0.25" becomes "less_than_0.25".
std::string BinKey(std::string_view name) {
  std::string key(name);
  std::ranges::replace(key, ' ', '_');
  return key;
}

TableColumn DistanceColumn(std::size_t bin) {
  return {BinKey(DistanceBinName(bin)), DistanceBinText(bin), "m"};
}

TableColumn OcclusionColumn(std::size_t bin) {
  return {BinKey(kOcclusionBinNames.at(bin)), std::string(kOcclusionBinNames.at(bin)), ""};
}

// A line for each of the types that are in most frames, over the bins of such a table.
Chart BinsChart(const Table& table, ChartAxis x) {
  // Numbers of persons and of anything else differ by orders of magnitude.
  Chart chart = {table.key,
                 table.title,
                 "Where a line is low or broken, the set shows few or none of that type",
                 std::move(x),
                 {"Objects, in each frame", "", true},
                 {}};
  chart.series = SeriesByRow(table, kMostTypes);
  chart.caption.text +=
      table.rows.size() > kMostTypes ? "; only the types that are in the most frames." : ".";
  return chart;
}

void AddObjects(const DatasetOverview& overview, Section& section) {
  std::vector<TypeCounts> types = overview.types;
  std::ranges::stable_sort(types, std::greater(), &TypeCounts::in_frames);
  section.tables.push_back(TypesTable(types));
  Table distances = BinsTable({"dataset_objects_by_distance", "Objects by distance", "", {}, {}},
                              types, &TypeCounts::by_distance, DistanceColumn);
  section.charts.push_back(BinsChart(distances, DistanceAxis("Distance")));
  section.tables.push_back(std::move(distances));
  section.tables.push_back(
      BinsTable({"dataset_points_by_distance", "Points on objects by distance", "", {}, {}}, types,
                &TypeCounts::points_by_distance, DistanceColumn));
  Table occlusions =
      BinsTable({"dataset_objects_by_occlusion",
                 "Objects by occlusion",
                 "Occlusion: the share of the firings onto the object that something else stops. "
                 "Not visible: no firing would meet it even alone.",
                 {},
                 {}},
                types, &TypeCounts::by_occlusion, OcclusionColumn);
  section.charts.push_back(BinsChart(
      occlusions,
      {"Occlusion", "", false, {"< 0.25", "0.25-0.5", "0.5-0.75", "0.75-1", "1", "not visible"}}));
  section.tables.push_back(std::move(occlusions));
}

// A table of numbers by name, with their shares of their sum.
Table CountsTable(Table table, const Counts& counts) {
  std::uint64_t sum = 0;
  for (const auto& [name, count] : counts) sum += count;
  for (const auto& [name, count] : counts) {
    table.rows.push_back({name, count, Percent(count, sum)});
  }
  return table;
}

void AddOrigins(const DatasetOverview& overview, Section& section) {
  const TableColumn share = {"share_percent", "Share", "%"};
  Table weathers = CountsTable(
      {"dataset_weathers",
       "Weathers",
       "Rain and snow: any that falls; fog: visibility up to 1,000 m; dry: none of these.",
       {{"weather", "Weather", ""}, {"scenarios", "Scenarios", ""}, share},
       {}},
      overview.weathers);
  section.charts.push_back(
      {weathers.key,
       weathers.title,
       "A short bar is a weather that the set hardly has.",
       {"", "", false, TextsOf(weathers, "weather")},
       {"Scenarios", ""},
       {SeriesOf(weathers, {"weather", "scenarios"}, "", SeriesStyle::kBars)}});
  section.tables.push_back(std::move(weathers));
  Table words = {"dataset_drawn",
                 "Words drawn",
                 "The options of the recipe's groups, and its draws of words, by the number of "
                 "scenarios.",
                 {{"draw", "Draw", ""},
                  {"word", "Word", ""},
                  {"scenarios", "Scenarios", ""},
                  {"share_percent", "Share", "%"}},
                 {}};
  for (const auto& [draw, counts] : overview.drawn) {
    for (std::vector<Cell>& row : CountsTable({}, counts).rows) {
      row.insert(row.begin(), draw);
      words.rows.push_back(std::move(row));
    }
  }
  if (!words.rows.empty()) section.tables.push_back(std::move(words));
  section.tables.push_back(CountsTable(
      {"dataset_bases", "Bases", "", {{"base", "Base", ""}, {"frames", "Frames", ""}, share}, {}},
      overview.frames_by_base));
  section.tables.push_back(CountsTable({"dataset_sensors",
                                        "Sensors",
                                        "",
                                        {{"sensor", "Sensor", ""}, {"frames", "Frames", ""}, share},
                                        {}},
                                       overview.frames_by_sensor));
}

}  // namespace

Section MakeDatasetSection(const DatasetOverview& overview, const std::string& suffix) {
  Section section{
      "dataset", "Data set " + ShownPath(overview.source), {OverviewText(overview)}, {}, {}};
  section.tables.push_back(SplitTable(overview));
  section.tables.push_back(FramesTable(overview));
  if (!overview.types.empty()) AddObjects(overview, section);
  section.tables.push_back(ClassesTable(overview));
  AddOrigins(overview, section);
  section.key += suffix;
  for (Chart& chart : section.charts) chart.key += suffix;
  for (Table& table : section.tables) table.key += suffix;
  return section;
}

}  // namespace railcast
