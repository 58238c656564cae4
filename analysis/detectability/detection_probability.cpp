#include "analysis/detectability/detection_probability.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <functional>
#include <numbers>
#include <span>
#include <utility>

#include "analysis/detectability/detect_report.h"
#include "analysis/estimate/estimate.h"
#include "analysis/report/words.h"
#include "core/base/text.h"

namespace railcast {
namespace {

std::vector<InspectedApproach> ApproachesOf(const std::vector<DetectRun>& runs,
                                            const std::string& object) {
  std::vector<InspectedApproach> approaches;
  for (const DetectRun& run : runs) {
    const auto found = run.detections.find(object);
    if (found == run.detections.end() || found->second.fate == Fate::kNeverApproached) continue;
    const std::span<const Sighting> approach = ApproachIn(run.courses.objects.at(object).sightings);
    approaches.push_back(
        {.nearest_m = approach.back().distance_m,
         .farthest_m = std::ranges::max(approach, {}, &Sighting::distance_m).distance_m,
         .detected_m = found->second.distance_m});
  }
  return approaches;
}

// The share of approaches that had detected by each distance.
ChartSeries SharesDetected(std::vector<double> detected_m) {
  std::ranges::sort(detected_m, std::greater{});
  const auto num = static_cast<double>(detected_m.size());
  ChartSeries steps{"share of approaches", SeriesStyle::kLine};
  double share = 0.0;
  for (std::size_t i = 0; i < detected_m.size() && detected_m[i] > 0.0; ++i) {
    steps.points.push_back({.x = detected_m[i], .y = share});
    share = static_cast<double>(i + 1) / num;
    steps.points.push_back({.x = detected_m[i], .y = share});
  }
  steps.points.push_back({.x = 0.0, .y = share});
  return steps;
}

std::string RoundedText(double value_m) {
  return NumberText(std::round(10.0 * value_m) / 10.0);
}

}  // namespace

std::vector<Inspection> InspectEach(const std::vector<InspectedApproach>& approaches) {
  constexpr double kLeast_m = 0.1;  // Things that are touched have no logarithm.
  double nearest_m = kLeast_m;
  double farthest_m = std::numeric_limits<double>::infinity();
  for (const InspectedApproach& approach : approaches) {
    nearest_m = std::max(nearest_m, approach.nearest_m);
    farthest_m = std::min(farthest_m, approach.farthest_m);
  }
  farthest_m = std::max(farthest_m, nearest_m);
  std::vector<Inspection> inspections;
  for (std::size_t i = 0; i < approaches.size(); ++i) {
    // Multiples of the golden ratio are spread evenly, however many there are.
    const double share = std::fmod((static_cast<double>(i) + 0.5) * std::numbers::phi, 1.0);
    const double distance_m = nearest_m * std::pow(farthest_m / nearest_m, share);
    inspections.push_back({.range_m = distance_m,
                           .num_detected = approaches[i].detected_m >= distance_m ? 1U : 0U,
                           .num_targets = 1});
  }
  return inspections;
}

double DistanceOf90With95(const std::vector<double>& detected_m) {
  if (detected_m.size() < DetectionFit::kMinTargets) {
    return std::numeric_limits<double>::quiet_NaN();
  }
  const double low_m = LimitsExceededBy90Percent(detected_m).low;
  return low_m > 0.0 ? low_m : std::numeric_limits<double>::quiet_NaN();
}

Cell AsymptoteCell(const DetectionFit& fit) {
  if (!fit.has_asymptote) return std::string();
  return Estimate{fit.curve.upper, fit.upper_low, fit.upper_high, fit.num_targets};
}

Chart ProbabilityChart(const std::string& object,
                       const std::vector<double>& detected_m,
                       const std::vector<Inspection>& inspected,
                       const DetectionFit& fit) {
  const bool has_curve = !std::isnan(fit.curve.middle_m);
  Chart chart =
      ChartOf(kDetectabilityWords, "probability", {{"object", object}, {"has_curve", has_curve}});
  chart.key = KeyOfObject("probability_", object);
  chart.series = {SharesDetected(detected_m)};
  const double d90_95_m = DistanceOf90With95(detected_m);
  if (!std::isnan(d90_95_m)) {
    chart.series.push_back({"0.9 with 95 % confidence",
                            SeriesStyle::kPoints,
                            {{.x = d90_95_m, .y = 0.9, .label = RoundedText(d90_95_m) + " m"}}});
  }
  if (!has_curve) return chart;
  ChartSeries inspections{"inspections", SeriesStyle::kPoints};
  double farthest_m = 0.0;
  for (const Inspection& each : inspected) {
    inspections.points.push_back({.x = each.range_m, .y = static_cast<double>(each.num_detected)});
    farthest_m = std::max(farthest_m, each.range_m);
  }
  ChartSeries curve{"curve of hit and miss", SeriesStyle::kLine};
  constexpr int kNumPoints = 200;
  for (int i = 1; i <= kNumPoints; ++i) {
    const double distance_m = farthest_m * i / kNumPoints;
    curve.points.push_back({.x = distance_m, .y = fit.curve.At(distance_m)});
  }
  chart.series.push_back(std::move(curve));
  chart.series.push_back(std::move(inspections));
  return chart;
}

Section MakeProbabilitySection(const std::vector<DetectRun>& runs,
                               const std::vector<Verdict>& verdicts) {
  std::vector<Chart> charts;
  Table table = TableOf(kDetectabilityWords, "probability");
  std::string too_few;
  for (const Verdict& verdict : verdicts) {
    if (!verdict.is_in_way || verdict.num_approached == 0) continue;
    const std::vector<InspectedApproach> approaches = ApproachesOf(runs, verdict.name);
    const std::vector<Inspection> inspections = InspectEach(approaches);
    if (inspections.size() < DetectionFit::kMinTargets) {
      if (!too_few.empty()) too_few += ", ";
      too_few += verdict.name + " (" + NumberText(inspections.size()) + ")";
      continue;
    }
    const DetectionFit fit = FitDetection(inspections);
    std::vector<double> detected_m;
    for (const InspectedApproach& each : approaches) {
      detected_m.push_back(std::isnan(each.detected_m) ? 0.0 : each.detected_m);
    }
    table.rows.push_back({verdict.name, fit.num_targets, fit.num_detected,
                          DistanceOf90With95(detected_m), fit.d90_m, fit.d90_95_m,
                          AsymptoteCell(fit)});
    if (charts.size() < kMaxCharts) {
      charts.push_back(ProbabilityChart(verdict.name, detected_m, inspections, fit));
    }
  }
  Section section =
      SectionOf(kDetectabilityWords, "probability",
                {{"min_targets", NumberText(DetectionFit::kMinTargets)}, {"too_few", too_few}});
  section.charts = std::move(charts);
  if (!table.rows.empty()) section.tables = {std::move(table)};
  return section;
}

}  // namespace railcast
