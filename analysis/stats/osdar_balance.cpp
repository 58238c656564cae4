#include <nlohmann/json.hpp>

#include "analysis/estimate/estimate.h"
#include "analysis/report/chart_columns.h"
#include "analysis/report/words.h"
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
  Table table =
      TableOf(kStatsWords, "osdar_balance", {{"source", osdar.at("source").get<std::string>()}});
  for (const auto& [name, counts] : classes) {
    table.rows.push_back({name, counts.here, Percent(counts.here, all.here), counts.osdar,
                          Percent(counts.osdar, all.osdar)});
  }
  Section section = SectionOf(kStatsWords, "osdar_balance");
  section.charts.push_back(ChartOfTable(kStatsWords, "osdar_balance", table));
  section.tables.push_back(std::move(table));
  return section;
}

}  // namespace railcast
