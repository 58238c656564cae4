#include "analysis/detectability/detection_probability.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <optional>
#include <span>
#include <string>
#include <utility>

#include "analysis/detectability/detect_report.h"
#include "analysis/estimate/detection_curve.h"
#include "core/base/text.h"

namespace railcast {
namespace {

/// The approach of one run, and when the object is detected in it.
struct SeenApproach {
  std::span<const Sighting> sightings;
  std::optional<std::uint32_t> detected_in;
};

std::vector<SeenApproach> ApproachesOf(const std::vector<DetectRun>& runs,
                                       const std::string& object) {
  std::vector<SeenApproach> approaches;
  for (const DetectRun& run : runs) {
    const auto found = run.detections.find(object);
    if (found == run.detections.end() || found->second.fate == Fate::kNeverApproached) continue;
    approaches.push_back(
        {ApproachIn(run.courses.objects.at(object).sightings), found->second.frame});
  }
  return approaches;
}

Inspection Inspect(const SeenApproach& approach, double distance_m) {
  const auto sighting = std::ranges::find_if(
      approach.sightings, [&](const Sighting& each) { return each.distance_m <= distance_m; });
  const Sighting& at = sighting == approach.sightings.end() ? approach.sightings.back() : *sighting;
  const bool is_detected = approach.detected_in && *approach.detected_in <= at.frame;
  return {.range_m = at.distance_m, .num_detected = is_detected ? 1U : 0U, .num_targets = 1};
}

std::string RoundedText(double value_m) {
  return NumberText(std::round(10.0 * value_m) / 10.0);
}

Chart ProbabilityChart(const std::string& object,
                       const std::vector<Inspection>& inspected,
                       const DetectionFit& fit) {
  Chart chart;
  chart.key = KeyOfObject("probability_", object);
  chart.title = "Probability that " + object + " is detected";
  chart.caption =
      "By the time it is as near as this. Each inspection is a point at 1 or 0; the curve is the "
      "most likely one.";
  chart.x = {.title = "Distance", .unit = "m"};
  chart.y = {.title = "Probability of detection", .unit = ""};
  ChartSeries inspections{"inspections", SeriesStyle::kPoints, {}};
  double farthest_m = 0.0;
  for (const Inspection& each : inspected) {
    inspections.points.push_back({.x = each.range_m, .y = static_cast<double>(each.num_detected)});
    farthest_m = std::max(farthest_m, each.range_m);
  }
  ChartSeries curve{"most likely", SeriesStyle::kLine, {}};
  constexpr int kNumPoints = 200;
  for (int i = 1; i <= kNumPoints; ++i) {
    const double distance_m = farthest_m * i / kNumPoints;
    curve.points.push_back({.x = distance_m, .y = fit.curve.At(distance_m)});
  }
  chart.series = {std::move(curve), std::move(inspections)};
  if (!std::isnan(fit.d90_95_m)) {
    chart.series.push_back(
        {"0.9 with 95 % confidence",
         SeriesStyle::kPoints,
         {{.x = fit.d90_95_m, .y = 0.9, .label = RoundedText(fit.d90_95_m) + " m"}}});
  }
  return chart;
}

/// Inspects an object once in each run that approaches it: whether it has been detected by the time
/// it is at a distance. The distances are spread evenly over the logarithm of those that all runs
/// have, so that inspections are independent of each other, as the fit assumes.
std::vector<Inspection> InspectionsOf(const std::vector<DetectRun>& runs,
                                      const std::string& object) {
  const std::vector<SeenApproach> approaches = ApproachesOf(runs, object);
  double nearest_m = 0.0;
  double farthest_m = std::numeric_limits<double>::infinity();
  for (const SeenApproach& approach : approaches) {
    nearest_m = std::max(nearest_m, approach.sightings.back().distance_m);
    farthest_m = std::min(
        farthest_m, std::ranges::max(approach.sightings, {}, &Sighting::distance_m).distance_m);
  }
  constexpr double kLeast_m = 0.1;  // Things that are touched have no logarithm.
  nearest_m = std::max(nearest_m, kLeast_m);
  std::vector<Inspection> inspections;
  for (std::size_t i = 0; i < approaches.size(); ++i) {
    // Multiples of the golden ratio are spread evenly, however many there are.
    const double share = std::fmod((static_cast<double>(i) + 0.5) * std::numbers::phi, 1.0);
    inspections.push_back(
        Inspect(approaches[i], nearest_m * std::pow(farthest_m / nearest_m, share)));
  }
  return inspections;
}

}  // namespace

Section MakeProbabilitySection(const std::vector<DetectRun>& runs,
                               const std::vector<Verdict>& verdicts) {
  Section section{.key = "probability", .title = "Probability of detection"};
  Table table;
  table.key = "probability";
  table.title = "Distances by which objects are detected with a probability of 0.9";
  table.note =
      "A log-logistic curve of hit and miss (MIL-HDBK-1823A), with an asymptote below 1 where the "
      "likelihood ratio asks for it; bounds by the profile likelihood. Each run is inspected once, "
      "since its frames are not independent.";
  table.is_open = true;
  table.columns = {{"object", "Object", ""},
                   {"inspections", "Inspections", ""},
                   {"detected", "Detected", ""},
                   {"d90_m", "0.9 at", "m"},
                   {"d90_95_m", "0.9 with 95 % confidence at", "m"},
                   {"asymptote", "Asymptote", ""}};
  std::string too_few;
  for (const Verdict& verdict : verdicts) {
    if (!verdict.is_in_way || verdict.num_approached == 0) continue;
    const std::vector<Inspection> inspections = InspectionsOf(runs, verdict.name);
    if (inspections.size() < DetectionFit::kMinTargets) {
      if (!too_few.empty()) too_few += ", ";
      too_few += verdict.name + " (" + NumberText(inspections.size()) + ")";
      continue;
    }
    const DetectionFit fit = FitDetection(inspections);
    table.rows.push_back(
        {verdict.name, fit.num_targets, fit.num_detected, fit.d90_m, fit.d90_95_m,
         Estimate{fit.curve.upper, fit.upper_low, fit.upper_high, fit.num_targets}});
    const bool has_curve = !std::isnan(fit.curve.middle_m);
    if (has_curve && section.charts.size() < kMaxCharts) {
      section.charts.push_back(ProbabilityChart(verdict.name, inspections, fit));
    }
  }
  if (!too_few.empty()) {
    section.paragraphs = {"Too few inspections for a probability of detection, which takes " +
                          NumberText(DetectionFit::kMinTargets) + ", one of each run: " + too_few +
                          "."};
  }
  if (!table.rows.empty()) section.tables = {std::move(table)};
  return section;
}

}  // namespace railcast
