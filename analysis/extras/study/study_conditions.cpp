#include <algorithm>
#include <cstddef>
#include <utility>

#include "analysis/detectability/detection_probability.h"
#include "analysis/estimate/estimate.h"
#include "analysis/extras/study/study_report.h"
#include "analysis/report/words.h"
#include "core/base/text.h"

namespace railcast {
namespace {

constexpr double kUnknown_m = std::numeric_limits<double>::quiet_NaN();

Table LevelTable(const std::vector<Observation>& observations, const std::vector<Factor>& factors) {
  Table table = TableOf(kStudyWords, "conditions");
  for (const Factor& factor : factors) {
    std::vector<ObservedGroup> cells(factor.levels.size());
    for (std::size_t i = 0; i < observations.size(); ++i) {
      cells[factor.level_of[i]].Add(observations[i]);
    }
    for (std::size_t level = 0; level < cells.size(); ++level) {
      const ObservedGroup& cell = cells[level];
      if (cell.num == 0) continue;
      double d90_m = kUnknown_m;
      if (cell.num >= DetectionFit::kMinTargets) d90_m = FitDetection(cell.inspections).d90_m;
      table.rows.push_back({factor.name, factor.levels[level], cell.num, cell.in_time_percent(),
                            DistanceOf90With95(cell.detected_m), d90_m});
    }
  }
  return table;
}

/// Two values together.
struct Pair {
  std::string one;
  std::string other;
  ObservedGroup cell;
};

// But for those of which the table of verdicts shows both factors.
std::vector<Pair> PairsOf(const std::vector<Observation>& observations,
                          const std::vector<Factor>& factors,
                          const std::vector<const Factor*>& in_table) {
  const auto is_in_table = [&](const Factor& factor) {
    return std::ranges::find(in_table, &factor) != in_table.end();
  };
  std::vector<Pair> pairs;
  for (std::size_t a = 0; a < factors.size(); ++a) {
    for (std::size_t b = a + 1; b < factors.size(); ++b) {
      if (is_in_table(factors[a]) && is_in_table(factors[b])) continue;
      const std::size_t num_b = factors[b].levels.size();
      std::vector<ObservedGroup> cells(factors[a].levels.size() * num_b);
      for (std::size_t i = 0; i < observations.size(); ++i) {
        cells[factors[a].level_of[i] * num_b + factors[b].level_of[i]].Add(observations[i]);
      }
      for (std::size_t i = 0; i < cells.size(); ++i) {
        const std::string& one = factors[a].levels[i / num_b];
        const std::string& other = factors[b].levels[i % num_b];
        if (cells[i].num_decided < kMinSamples || one == kNotDrawn || other == kNotDrawn) continue;
        pairs.push_back(
            {factors[a].name + ": " + one, factors[b].name + ": " + other, std::move(cells[i])});
      }
    }
  }
  return pairs;
}

// Pairs of values that are worse than all together by more than chance.
Table FailingTable(const std::vector<Observation>& observations,
                   const std::vector<Factor>& factors,
                   const std::vector<const Factor*>& in_table) {
  constexpr std::size_t kMostPairs = 10;
  ObservedGroup all;
  for (const Observation& each : observations) all.Add(each);
  const double usual = all.in_time_percent().value;
  std::vector<Pair> pairs = PairsOf(observations, factors, in_table);
  std::erase_if(pairs,
                [&](const Pair& pair) { return !(pair.cell.in_time_percent().high < usual); });
  std::ranges::stable_sort(pairs, {},
                           [](const Pair& pair) { return pair.cell.in_time_percent().high; });
  pairs.resize(std::min(pairs.size(), kMostPairs));
  Table table = TableOf(kStudyWords, "failing");
  for (const Pair& pair : pairs) {
    table.rows.push_back({pair.one, pair.other, pair.cell.num, pair.cell.in_time_percent()});
  }
  return table;
}

}  // namespace

Section ConditionsSection(const std::vector<Observation>& observations,
                          const std::vector<Factor>& factors,
                          const std::vector<const Factor*>& in_table) {
  Section section = SectionOf(kStudyWords, "conditions", {{"none", factors.empty()}});
  if (factors.empty()) return section;
  section.tables = {LevelTable(observations, factors)};
  Table failing = FailingTable(observations, factors, in_table);
  if (!failing.rows.empty()) section.tables.push_back(std::move(failing));
  return section;
}

Section FactorsSection(const std::vector<FactorWeight>& weights, std::size_t num_observations) {
  Section section = SectionOf(kStudyWords, "factors");
  if (weights.empty()) {
    section.paragraphs = {"Too few approaches to weigh the factors: each value asks for ten (got " +
                          NumberText(num_observations) + " approaches)."};
    return section;
  }
  Table table = TableOf(kStudyWords, "factors");
  Chart chart = ChartOf(kStudyWords, "factors");
  ChartSeries bars{"share", SeriesStyle::kBars};
  for (const FactorWeight& weight : weights) {
    table.rows.push_back({weight.name, std::uint64_t{weight.degrees}, weight.ratio, weight.p_value,
                          100.0 * weight.share});
    if (weight.name == kDistance) continue;
    bars.points.push_back(
        {.x = static_cast<double>(bars.points.size()), .y = 100.0 * weight.share});
    chart.x.categories.push_back(weight.name);
  }
  chart.series = {std::move(bars)};
  section.tables = {std::move(table)};
  section.charts = {std::move(chart)};
  return section;
}

}  // namespace railcast
