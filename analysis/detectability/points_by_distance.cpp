#include "analysis/detectability/detect_report.h"

#include <algorithm>
#include <cmath>

#include "analysis/estimate/streams.h"
#include "analysis/report/words.h"
#include "core/base/text.h"

namespace railcast {
namespace {

/// The frames in one bin of distance.
struct Bin {
  Moments points;
  std::uint64_t num_enough{};  ///< Frames with as many points as the rule asks for.
};

/// By bin; bins without a frame are absent.
using BinsByDistance = std::map<std::uint32_t, Bin>;

BinsByDistance BinsOf(const std::vector<DetectRun>& runs,
                      const std::string& name,
                      const DetectionRule& rule) {
  BinsByDistance bins;
  for (const DetectRun& run : runs) {
    const auto object = run.courses.objects.find(name);
    if (object == run.courses.objects.end()) continue;
    const std::vector<Sighting>& sightings = object->second.sightings;
    const auto closest = std::ranges::min_element(sightings, {}, &Sighting::distance_m);
    for (auto sighting = sightings.begin(); sighting != sightings.end() && sighting <= closest;
         ++sighting) {
      Bin& bin = bins[static_cast<std::uint32_t>(sighting->distance_m / kDistanceBin_m)];
      bin.points.Add(sighting->points);
      bin.num_enough += sighting->points >= rule.min_points ? 1U : 0U;
    }
  }
  return bins;
}

ChartSeries Upright(const std::string& title, double x, double high) {
  ChartSeries series{title + " " + NumberText(std::round(x)) + " m", SeriesStyle::kLine};
  constexpr double kLow = 0.1;
  for (const double y : {kLow, high}) series.points.push_back({.x = x, .y = y});
  return series;
}

}  // namespace

std::string KeyOfObject(const std::string& prefix, const std::string& name) {
  std::string key = prefix;
  for (const char letter : name) {
    const bool is_plain = (letter >= 'a' && letter <= 'z') || (letter >= '0' && letter <= '9');
    if (is_plain || letter == '_') {
      key += letter;
    } else {
      key += '-';
      key += NumberText(static_cast<int>(static_cast<unsigned char>(letter)));
    }
  }
  return key;
}

Table PointsTable(const std::vector<DetectRun>& runs, const DetectionRule& rule) {
  Table table = TableOf(kDetectabilityWords, "points_by_distance",
                        {{"min_points", NumberText(rule.min_points)}});
  for (const Verdict& verdict : MakeVerdicts(runs)) {
    for (const auto& [index, bin] : BinsOf(runs, verdict.name, rule)) {
      table.rows.push_back({verdict.name,
                            Span{kDistanceBin_m * index, kDistanceBin_m * (index + 1)},
                            bin.points.num(), bin.points.Mean(),
                            PercentProportion(bin.num_enough, bin.points.num())});
    }
  }
  return table;
}

Chart PointsChart(const std::vector<DetectRun>& runs,
                  const Verdict& verdict,
                  const DetectionRule& rule) {
  Chart chart = ChartOf(kDetectabilityWords, "points",
                        {{"object", verdict.name}, {"is_in_way", verdict.is_in_way}});
  chart.key = KeyOfObject("points_", verdict.name);
  ChartSeries points{verdict.name, SeriesStyle::kLinePoints};
  double highest = rule.min_points;
  double farthest_m = verdict.is_in_way ? verdict.most_needed_m : 0.0;
  std::uint32_t next_index = 0;
  for (const auto& [index, bin] : BinsOf(runs, verdict.name, rule)) {
    const double mean = bin.points.PlainMean();
    const double middle_m = kDistanceBin_m * (index + 0.5);
    farthest_m = std::max(farthest_m, middle_m);
    // Bins that no frame falls into are gaps, too.
    for (; next_index < index && !points.points.empty(); ++next_index) {
      points.points.push_back({.x = kDistanceBin_m * (next_index + 0.5)});
    }
    next_index = index + 1;
    if (!(mean > 0.0)) {
      points.points.push_back({.x = middle_m});
      continue;
    }
    highest = std::max(highest, mean);
    points.points.push_back({.x = middle_m, .y = mean});
    const Estimate estimate = bin.points.Mean();
    if (!estimate.is_enough()) continue;
    // A logarithmic axis cannot show an interval that reaches 0.
    points.points.back().low = estimate.low > 0.0 ? estimate.low : mean;
    points.points.back().high = estimate.high;
    highest = std::max(highest, estimate.high);
  }
  chart.series.push_back(std::move(points));
  ChartSeries enough{"detected from " + NumberText(rule.min_points) + " points on",
                     SeriesStyle::kLine};
  const double min_points = rule.min_points;
  enough.points = {{.x = 0.0, .y = min_points}, {.x = farthest_m, .y = min_points}};
  chart.series.push_back(std::move(enough));
  if (verdict.is_in_way) {
    chart.series.push_back(Upright("needed:", verdict.most_needed_m, highest));
  }
  if (verdict.distance_m.num() > 0) {
    chart.series.push_back(Upright("detected at:", verdict.distance_m.PlainMean(), highest));
  }
  return chart;
}

}  // namespace railcast
