#include <algorithm>
#include <map>
#include <utility>

#include "analysis/detectability/detection_probability.h"
#include "analysis/estimate/streams.h"
#include "analysis/extras/study/study_factors.h"
#include "analysis/extras/study/study_report.h"
#include "analysis/report/words.h"
#include "core/extras/recipe/json_place.h"

namespace railcast {
namespace {

/// A target seen from one placement.
struct PlacedView {
  std::string placement;
  std::string target;
  ObservedGroup seen;
};

bool ChangesSensor(const Factor& factor, const Json& recipe) {
  return factor.name == "sensor" ||
         std::ranges::any_of(DrawnKeys(factor.name, recipe), [](const std::string& key) {
           return LiesWithin(key, "/lidar") || LiesWithin(key, "/lidars");
         });
}

std::string PlacementOf(std::size_t observation, const std::vector<const Factor*>& factors) {
  std::string text;
  for (const Factor* factor : factors) {
    if (!text.empty()) text += ", ";
    const std::string& level = factor->levels[factor->level_of[observation]];
    const bool is_number = !factor->numbers.empty();
    text += is_number ? factor->name.substr(factor->name.rfind('/') + 1) + " " + level : level;
  }
  return text;
}

// By target; the placement that sees it from farthest away first.
std::vector<PlacedView> ViewsOf(const std::vector<Observation>& observations,
                                const std::vector<const Factor*>& factors) {
  std::map<std::pair<std::string, std::string>, PlacedView> views;
  for (std::size_t i = 0; i < observations.size(); ++i) {
    const std::string target = observations[i].object->Target();
    const std::string placement = PlacementOf(i, factors);
    PlacedView& view = views[{target, placement}];
    view.placement = placement;
    view.target = target;
    view.seen.Add(observations[i]);
  }
  std::vector<PlacedView> sorted;
  for (auto& [key, view] : views) sorted.push_back(std::move(view));
  std::ranges::stable_sort(sorted, [](const PlacedView& one, const PlacedView& other) {
    if (one.target != other.target) return one.target < other.target;
    return one.seen.distance_m.PlainMean() > other.seen.distance_m.PlainMean();
  });
  return sorted;
}

// Whether the table of verdicts has the rows of the section's own.
bool ArePlacementsAndTargets(const std::vector<const Factor*>& in_table,
                             std::vector<const Factor*> of_sensor,
                             const std::vector<Factor>& factors) {
  const auto target = std::ranges::find(factors, kTarget, &Factor::name);
  if (target != factors.end()) of_sensor.push_back(&*target);
  return std::ranges::is_permutation(in_table, of_sensor);
}

Chart PlacementChart(const std::vector<PlacedView>& views) {
  constexpr std::size_t kMostPlacements = 12;
  Chart chart = ChartOf(kStudyWords, "placement");
  std::map<std::string, std::size_t> place_of;
  for (const PlacedView& view : views) {
    if (chart.series.empty() || chart.series.back().title != view.target) {
      chart.series.push_back({view.target, SeriesStyle::kBars});
    }
    if (!place_of.contains(view.placement)) {
      if (place_of.size() == kMostPlacements) continue;
      place_of.emplace(view.placement, place_of.size());
      chart.x.categories.push_back(view.placement);
    }
    chart.series.back().points.push_back(
        PointAt(static_cast<double>(place_of.at(view.placement)), view.seen.distance_m.Mean()));
  }
  return chart;
}

}  // namespace

Section PlacementSection(const std::vector<Observation>& observations,
                         const std::vector<Factor>& factors,
                         const std::vector<const Factor*>& in_table,
                         const Json& recipe) {
  std::vector<const Factor*> of_sensor;
  for (const Factor& factor : factors) {
    if (ChangesSensor(factor, recipe)) of_sensor.push_back(&factor);
  }
  Section section = SectionOf(kStudyWords, "placement");
  if (of_sensor.empty()) return section;
  const std::vector<PlacedView> views = ViewsOf(observations, of_sensor);
  Table table = TableOf(kStudyWords, "placement");
  for (const PlacedView& view : views) {
    const ObservedGroup& seen = view.seen;
    table.rows.push_back({view.target, view.placement, seen.num, seen.num_detected,
                          seen.in_time_percent(), seen.distance_m.Mean(),
                          DistanceOf90With95(seen.detected_m)});
  }
  if (ArePlacementsAndTargets(in_table, of_sensor, factors)) {
    for (const std::string key : {"approaches", "in_time_percent", "d90_95_m"}) {
      const auto at =
          std::ranges::find(table.columns, key, &TableColumn::key) - table.columns.begin();
      table.columns.erase(table.columns.begin() + at);
      for (std::vector<Cell>& row : table.rows) row.erase(row.begin() + at);
    }
  }
  section.tables = {std::move(table)};
  section.charts = {PlacementChart(views)};
  return section;
}

}  // namespace railcast
