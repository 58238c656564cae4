#include <set>

#include "analysis/report/chart_script.h"

namespace railcast {

// Colours the graph whose nodes are titles and whose edges join those that meet in a chart, in the
// order in which they first appear. As few charts have more than seven series, dashes are rare.
SeriesPaints PaintsOf(const std::vector<Chart>& charts) {
  std::map<std::string, std::set<std::string>> met_by_title;
  for (const Chart& chart : charts) {
    for (const ChartSeries& one : chart.series) {
      for (const ChartSeries& other : chart.series) met_by_title[one.title].insert(other.title);
    }
  }
  SeriesPaints paints;
  for (const Chart& chart : charts) {
    for (const ChartSeries& series : chart.series) {
      if (paints.contains(series.title)) continue;
      std::set<std::size_t> taken;
      for (const std::string& title : met_by_title[series.title]) {
        if (const auto met = paints.find(title); met != paints.end()) taken.insert(met->second);
      }
      std::size_t paint = 0;
      while (taken.contains(paint)) ++paint;
      paints.emplace(series.title, paint);
    }
  }
  return paints;
}

}  // namespace railcast
