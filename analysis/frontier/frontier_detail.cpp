// The table of what scene detail `auto` changes.
#include "analysis/frontier/frontier_report.h"
#include "analysis/report/cell_text.h"

namespace railcast {
namespace {

constexpr double kInPercent = 100.0;

std::string ClassName(std::uint32_t label, const LabelTable& labels) {
  const Label* const found = labels.Find(label);
  return found == nullptr ? std::to_string(label) : found->name;
}

}  // namespace

Table DetailTable(const LabelTable& labels, const std::vector<RowResult>& results) {
  Table table = {"detail_by_range",
                 "What scene detail auto changes",
                 "How many more first echoes of their firings, and further ones, there are than in "
                 "the same row in full detail, and how much larger the first ones' mean intensity "
                 "is, by class and range, where full detail has 400 first echoes or more. 0 is no "
                 "change. Intervals are of 95 %, from the differences between frames.",
                 {{"row", "Row", ""},
                  {"class", "Class", ""},
                  {"range", "Range", "m"},
                  {"first_percent", "First echoes", "%"},
                  {"further_percent", "Further echoes", "%"},
                  {"intensity_percent", "Mean intensity", "%"}},
                 {}};
  for (const RowResult& result : results) {
    for (const DetailDifference& difference : result.detail_differences) {
      const double from_m = kDetailBin_m * difference.bin;
      table.rows.push_back(
          {result.row.name, ClassName(difference.label, labels),
           Span{from_m, from_m + kDetailBin_m}, Scaled(difference.first, kInPercent),
           Scaled(difference.further, kInPercent), Scaled(difference.intensity, kInPercent)});
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
  return Section{
      .key = "scene_detail",
      .title = "Scene detail",
      .paragraphs = {Joined(
          {"Rows with +auto_detail trace a scene as coarse as world.detail auto permits. "
           "Their echoes are other ones, about as many and as strong, and cannot be matched with "
           "those of the reference. Their differences here are statistical, over ",
           CountText(plan.detail_frames.size()),
           " frames, and must not be compared with the errors of the other rows."})},
      .tables = {std::move(table)}};
}

}  // namespace railcast
