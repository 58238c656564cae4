#include "analysis/extras/study/study_report.h"

#include <cmath>
#include <map>
#include <utility>

#include "analysis/detectability/detect_report.h"
#include "analysis/detectability/detection_probability.h"
#include "analysis/estimate/estimate.h"
#include "core/base/text.h"

namespace railcast {

std::vector<TargetResult> TargetsOf(const std::vector<Observation>& observations) {
  std::map<std::string, TargetResult> by_target;
  // Of an approach that began too near to tell, it is not known from where it would be detected.
  std::map<std::string, std::vector<double>> at_most_m;
  for (const Observation& each : observations) {
    const StudiedObject& object = *each.object;
    TargetResult& target = by_target[object.Target()];
    if (target.seen.num == 0) target.type = object.type;
    target.seen.Add(each);
    if (object.is_detected && !object.is_from_start) {
      target.least_distance_m = std::fmin(target.least_distance_m, object.distance_m);
    }
    target.most_needed_m = std::fmax(target.most_needed_m, object.needed_m);
    at_most_m[object.Target()].push_back(
        object.is_undecided() ? std::numeric_limits<double>::infinity() : object.detected_m());
  }
  std::vector<TargetResult> results;
  for (auto& [name, target] : by_target) {
    target.name = name;
    if (target.has_fit()) {
      target.fit = FitDetection(target.seen.inspections);
      target.d90_95_m = DistanceOf90With95(target.seen.detected_m);
      target.d90_at_most_m = LimitsExceededBy90Percent(at_most_m[name]).high;
    }
    results.push_back(std::move(target));
  }
  return results;
}

std::string AnswerOf(const TargetResult& target) {
  if (!target.has_fit()) {
    return "too few approaches: " + NumberText(DetectionFit::kMinTargets) + " are needed";
  }
  if (target.d90_95_m >= target.most_needed_m) return "yes";
  return target.d90_at_most_m < target.most_needed_m ? "no" : "not shown";
}

Section VerdictSection(const std::vector<TargetResult>& targets) {
  Table table{
      .key = "verdicts",
      .title = "Is it detected before the distance that the train needs?",
      .note =
          "Yes if 90 % are detected, with 95 % confidence, by the greatest distance needed, and no "
          "if with the same confidence they are not, both by the ranks of all distances of "
          "detection; between the two, it is not shown. The curve is that of hit and miss "
          "(MIL-HDBK-1823A), which inspects each approach once. The share in time is of the "
          "approaches that did not begin too near to tell.",
      .columns = ColumnsOf(
          "target: Target; answer: Detected in time; approaches: Approaches; detected: Detected; "
          "in_time_percent: In time; d90_95_m: 0.9 with 95 % confidence at; curve_d90_m: Curve: "
          "0.9 at; curve_d90_95_m: Curve: with 95 % confidence; most_needed_m: Needed, at most; "
          "least_detected_at_m: Detected at, at least; asymptote: Asymptote"),
      .is_open = true};
  for (const TargetResult& target : targets) {
    const ObservedGroup& seen = target.seen;
    table.rows.push_back({target.name, AnswerOf(target), seen.num, seen.num_detected,
                          seen.in_time_percent(), target.d90_95_m, target.fit.d90_m,
                          target.fit.d90_95_m, target.most_needed_m, target.least_distance_m,
                          target.has_fit() ? AsymptoteCell(target.fit) : Cell(std::string())});
  }
  Section section{.key = "verdict", .title = "Verdict"};
  section.tables.push_back(std::move(table));
  for (const TargetResult& target : targets) {
    if (!target.has_fit() || section.charts.size() >= kMaxCharts) continue;
    section.charts.push_back(
        ProbabilityChart(target.name, target.seen.detected_m, target.seen.inspections, target.fit));
  }
  return section;
}

}  // namespace railcast
