#include <nlohmann/json.hpp>

#include "analysis/estimate/estimate.h"
#include "analysis/report/cell_text.h"
#include "analysis/report/chart_columns.h"
#include "analysis/stats/difficulty.h"

namespace railcast {

extern const char* const kOsdarCuboids;  // osdar23_cuboids.json, compiled in.

namespace {

constexpr const char* kNoOsdarClass = "none of OSDaR23";

struct CuboidCounts {
  std::uint64_t here{};
  std::uint64_t osdar{};
};

std::uint64_t WithPoints(const Difficulty::Counts& counts) {
  std::uint64_t num = 0;
  const auto& by_points = counts.at(static_cast<std::size_t>(Difficulty::Scale::kPoints));
  for (const Difficulty::Count& count : by_points) num += count.points > 0 ? count.objects : 0;
  return num;
}

std::string OsdarClassOf(const std::string& label, const LabelTable& labels) {
  const Label* const found = labels.Find(label);
  return found == nullptr || found->osdar23.empty() ? kNoOsdarClass : found->osdar23;
}

}  // namespace

Section MakeOsdarBalanceSection(const Difficulty& objects, const LabelTable& labels) {
  const auto osdar = nlohmann::json::parse(kOsdarCuboids);
  std::map<std::string, CuboidCounts> classes;
  CuboidCounts all;
  for (const auto& [label, counts] : objects.by_label()) {
    const std::uint64_t num = WithPoints(counts);
    classes[OsdarClassOf(label, labels)].here += num;
    all.here += num;
  }
  for (const auto& [name, num] : osdar.at("cuboids").items()) {
    classes[name].osdar = num;
    all.osdar += classes[name].osdar;
  }
  Table table = {
      "osdar_balance",
      "Objects by class, beside OSDaR23",
      Joined({"Objects with points, counted in each frame. OSDaR23: cuboids of its lidar; ",
              osdar.at("source").get<std::string>(), "."}),
      ColumnsOf("class: Class; objects: Objects; objects_percent: Share; osdar23_cuboids: OSDaR23; "
                "osdar23_percent: Share in OSDaR23"),
      {},
      true};
  for (const auto& [name, counts] : classes) {
    table.rows.push_back({name, counts.here, Percent(counts.here, all.here), counts.osdar,
                          Percent(counts.osdar, all.osdar)});
  }
  Section section{"osdar_balance", "Objects beside OSDaR23"};
  section.paragraphs = {
      "OSDaR23's shares are those of ten frames of one place, whose labels are at hand, and not of "
      "the whole data set. Its catenary poles have cuboids, whereas masts are no objects here. "
      "Shares of its points are not at hand."};
  section.charts.push_back(
      {"osdar_balance",
       "Objects by class",
       "Where the bar of this data is much the shorter, a detector trained on it sees too few of "
       "that class.",
       {"", "", false, TextsOf(table, "class")},
       {"Share", "%"},
       {SeriesOf(table, {"class", "objects_percent"}, "here", SeriesStyle::kBars),
        SeriesOf(table, {"class", "osdar23_percent"}, "OSDaR23 (one sequence)",
                 SeriesStyle::kBars)}});
  section.tables.push_back(std::move(table));
  return section;
}

}  // namespace railcast
