// The tables and charts of errors by range, by class and by object, and the table of what scene
// detail `auto` changes.
#include <algorithm>

#include "analysis/detectability/object_detection.h"
#include "analysis/frontier/frontier_report.h"
#include "analysis/report/cell_text.h"
#include "analysis/report/chart_columns.h"
#include "analysis/report/words.h"
#include "analysis/stats/names.h"

namespace railcast {
namespace {

constexpr double kToPercent = 100.0;

Estimate MissedPercent(const Matched& matched) {
  return Scaled(Proportion(matched.num_missed(), matched.num), kToPercent);
}

void AddPart(const std::string& row, const PartDifference& part, Table& table) {
  if (part.reference_echoes.num == 0 && part.echoes.num == 0) return;
  const double from_m = kRangeBin_m * part.part.id;
  const Cell place = part.part.kind == ScenePart::Kind::kRangeBin
                         ? Cell(Span{from_m, from_m + kRangeBin_m})
                         : Cell(part.part.name);
  table.rows.push_back({row, place, part.reference_echoes.num, MissedPercent(part.reference_echoes),
                        part.echoes.num, MissedPercent(part.echoes), 1e3 * part.range_m.median,
                        kToPercent * part.intensity.median});
}

// @param kind, what, column Of the parts: "class" and "class: Class".
Table PartsTable(const std::vector<RowResult>& results,
                 ScenePart::Kind kind,
                 const std::string& what,
                 const std::string& column) {
  Table table = TableOf(kFrontierWords, "by_part", {{"what", what}, {"column", column}});
  table.key = "by_" + what;
  for (const RowResult& result : results) {
    if (!result.difference) continue;
    for (const PartDifference& part : result.difference->parts) {
      if (part.part.kind == kind) AddPart(result.row.name, part, table);
    }
  }
  return table;
}

Table DetectionTable(const std::vector<RowResult>& results) {
  Table table = TableOf(kFrontierWords, "detection_distances",
                        {{"min_points", std::to_string(DetectionRule{}.min_points)}});
  for (const RowResult& result : results) {
    if (!result.difference) continue;
    for (const Approach& approach : result.difference->approaches) {
      if (approach.points.size() < 2) continue;
      std::uint64_t most = 0;
      for (const ApproachPoints& frame : approach.points) {
        most = std::max<std::uint64_t>(most, frame.points_in_reference);
      }
      if (most == 0) continue;
      table.rows.push_back({result.row.name, approach.object,
                            DetectionDistance_m(approach, &ApproachPoints::points_in_reference),
                            DetectionDistance_m(approach, &ApproachPoints::points), most});
    }
  }
  return table;
}

// The rungs and the choice; brute force would hide them.
Chart ErrorByRangeChart(const std::vector<RowResult>& results,
                        const Table& by_range,
                        const std::string& column) {
  Chart chart = ChartOf(kFrontierWords, column + "_by_range");
  for (const RowResult& result : results) {
    const RowGroup group = result.row.group;
    if (!result.difference || (group != RowGroup::kLadder && group != RowGroup::kChosen)) continue;
    const bool is_choice = group == RowGroup::kChosen;
    chart.series.push_back(SeriesOf(by_range, {"range", column, "", "row", result.row.name},
                                    is_choice ? "fidelity auto" : result.row.name,
                                    is_choice ? SeriesStyle::kPoints : SeriesStyle::kLinePoints));
  }
  return chart;
}

}  // namespace

Section PartsSection(const std::vector<RowResult>& results) {
  Section section = SectionOf(kFrontierWords, "parts");
  section.tables = {PartsTable(results, ScenePart::Kind::kRangeBin, "range", "range [m]: Range"),
                    PartsTable(results, ScenePart::Kind::kClass, "class", "class: Class"),
                    PartsTable(results, ScenePart::Kind::kObject, "object", "object: Object"),
                    DetectionTable(results)};
  section.charts = {ErrorByRangeChart(results, section.tables.front(), "missed_percent"),
                    ErrorByRangeChart(results, section.tables.front(), "false_percent")};
  std::erase_if(section.tables, [](const Table& table) { return table.rows.empty(); });
  return section;
}

Table DetailTable(const LabelTable& labels, const std::vector<RowResult>& results) {
  Table table = TableOf(kFrontierWords, "detail_by_range");
  for (const RowResult& result : results) {
    for (const DetailDifference& difference : result.detail_differences) {
      const double from_m = kDetailBin_m * difference.bin;
      table.rows.push_back(
          {result.row.name, LabelName(difference.label, labels),
           Span{from_m, from_m + kDetailBin_m}, Scaled(difference.first, kToPercent),
           Scaled(difference.further, kToPercent), Scaled(difference.intensity, kToPercent)});
    }
  }
  return table;
}

std::optional<Section> DetailSection(const FrontierPlan& plan,
                                     const LabelTable& labels,
                                     const std::vector<RowResult>& results) {
  Table table = DetailTable(labels, results);
  if (table.rows.empty()) return std::nullopt;
  table.is_open = true;
  Section section = SectionOf(kFrontierWords, "scene_detail",
                              {{"num_frames", CountText(plan.detail_frames.size())}});
  section.tables = {std::move(table)};
  return section;
}

}  // namespace railcast
