#include "analysis/extras/study/study_report.h"

#include <cmath>
#include <map>
#include <utility>

#include "analysis/detectability/detect_report.h"
#include "analysis/detectability/detection_probability.h"
#include "analysis/estimate/estimate.h"
#include "analysis/report/words.h"
#include "core/base/text.h"

namespace railcast {

std::vector<TargetResult> TargetsOf(const std::vector<Observation>& observations) {
  std::map<std::string, TargetResult> by_target;
  for (const Observation& each : observations) {
    const StudiedObject& object = *each.object;
    TargetResult& target = by_target[object.Target()];
    if (target.seen.num == 0) target.type = object.type;
    target.seen.Add(each);
    if (object.is_detected && !object.is_from_start) {
      target.least_distance_m = std::fmin(target.least_distance_m, object.distance_m);
    }
  }
  std::vector<TargetResult> results;
  for (auto& [name, target] : by_target) {
    target.name = name;
    target.d90_95_m = DistanceOf90With95(target.seen.detected_m);
    if (target.has_fit()) target.fit = FitDetection(target.seen.inspections);
    results.push_back(std::move(target));
  }
  return results;
}

Judgement AnswerOf(const ObservedGroup& seen) {
  if (seen.num < DetectionFit::kMinTargets) {
    return {"too few approaches: " + NumberText(DetectionFit::kMinTargets) + " are needed"};
  }
  if (DistanceOf90With95(seen.detected_m) >= seen.most_needed_m) return {"yes", Grade::kGood};
  // What 90 % do not exceed with 95 % confidence: if this is less than needed, it is too late.
  const double at_most_m = LimitsExceededBy90Percent(seen.at_most_m).high;
  return at_most_m < seen.most_needed_m ? Judgement{"no", Grade::kBad} : Judgement{"not shown"};
}

std::vector<Headline> VerdictHeadlines(const std::vector<TargetResult>& targets) {
  std::vector<Headline> headlines;
  for (const TargetResult& target : targets) {
    headlines.push_back(
        {.title = target.name + ": detected in time", .value = AnswerOf(target.seen)});
    headlines.push_back({.title = target.name + ": 0.9 with 95 % confidence at",
                         .unit = "m",
                         .value = target.d90_95_m});
    headlines.push_back({.title = target.name + ": needed, at most",
                         .unit = "m",
                         .value = target.seen.most_needed_m});
  }
  return headlines;
}

Section VerdictSection(const std::vector<TargetResult>& targets) {
  Table table = TableOf(kStudyWords, "verdicts");
  for (const TargetResult& target : targets) {
    const ObservedGroup& seen = target.seen;
    table.rows.push_back({target.name, AnswerOf(seen), seen.num, seen.num_detected,
                          seen.in_time_percent(), target.d90_95_m, target.fit.d90_m,
                          target.fit.d90_95_m, seen.most_needed_m, target.least_distance_m,
                          target.has_fit() ? AsymptoteCell(target.fit) : Cell(std::string())});
  }
  Section section = SectionOf(kStudyWords, "verdict");
  section.tables.push_back(std::move(table));
  for (const TargetResult& target : targets) {
    if (!target.has_fit() || section.charts.size() >= kMaxCharts) continue;
    section.charts.push_back(
        ProbabilityChart(target.name, target.seen.detected_m, target.seen.inspections, target.fit));
  }
  return section;
}

}  // namespace railcast
