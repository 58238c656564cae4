#include "analysis/study/study_report.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <nlohmann/json.hpp>
#include <utility>

#include "analysis/detectability/detect_report.h"
#include "analysis/detectability/detection_probability.h"
#include "analysis/estimate/detection_curve.h"
#include "core/base/text.h"
#include "core/io/run/sequence_files.h"

namespace railcast {

extern const char* const kYardsticks;

namespace {

constexpr double kUnknownFigure = std::numeric_limits<double>::quiet_NaN();

/// What is known of one target.
struct TargetResult {
  std::string name;
  std::vector<Inspection> inspections;
  std::uint64_t num_detected{};
  std::uint64_t num_in_time{};
  std::uint64_t num_undecided{};
  double least_distance_m = kUnknownFigure;
  double most_needed_m = kUnknownFigure;
  DetectionFit fit{};
  bool has_fit{};
};

std::vector<TargetResult> ResultsOf(const std::vector<Observation>& observations) {
  std::map<std::string, TargetResult> by_target;
  for (const Observation& each : observations) {
    const StudiedObject& object = *each.object;
    TargetResult& target = by_target[object.Target()];
    target.inspections.push_back(each.inspection);
    target.num_detected += object.is_detected ? 1U : 0U;
    target.num_in_time += object.is_in_time() ? 1U : 0U;
    target.num_undecided += object.is_undecided() ? 1U : 0U;
    if (object.is_detected && !object.is_from_start) {
      target.least_distance_m = std::fmin(target.least_distance_m, object.distance_m);
    }
    target.most_needed_m = std::fmax(target.most_needed_m, object.needed_m);
  }
  std::vector<TargetResult> results;
  for (auto& [name, target] : by_target) {
    target.name = name;
    target.has_fit = target.inspections.size() >= DetectionFit::kMinTargets;
    if (target.has_fit) target.fit = FitDetection(target.inspections);
    results.push_back(std::move(target));
  }
  return results;
}

std::string AnswerOf(const TargetResult& target) {
  if (!target.has_fit) {
    return "too few approaches: " + NumberText(DetectionFit::kMinTargets) + " are needed";
  }
  if (std::isnan(target.fit.d90_95_m)) return "no distance has 0.9 with 95 % confidence";
  return target.fit.d90_95_m >= target.most_needed_m ? "yes" : "no";
}

Section TargetsSection(const StudySpec& study, const std::vector<TargetResult>& targets) {
  Table table;
  table.key = "verdicts";
  table.title = "Is it detected before the distance that the train needs?";
  table.note =
      "Yes if the distance by which 90 % are detected, with 95 % confidence, is not less than the "
      "greatest distance needed. The share in time is of the approaches that did not begin too "
      "near "
      "to tell.";
  table.is_open = true;
  table.columns = {{"target", "Target", ""},
                   {"answer", "Detected in time", ""},
                   {"approaches", "Approaches", ""},
                   {"detected", "Detected", ""},
                   {"in_time", "In time", ""},
                   {"d90_m", "0.9 at", "m"},
                   {"d90_95_m", "0.9 with 95 % confidence at", "m"},
                   {"most_needed_m", "Needed, at most", "m"},
                   {"least_detected_at_m", "Detected at, at least", "m"},
                   {"asymptote", "Asymptote", ""}};
  for (const TargetResult& target : targets) {
    const std::uint64_t num = target.inspections.size();
    table.rows.push_back({target.name, AnswerOf(target), num, target.num_detected,
                          Proportion(target.num_in_time, num - target.num_undecided),
                          target.has_fit ? target.fit.d90_m : kUnknownFigure,
                          target.has_fit ? target.fit.d90_95_m : kUnknownFigure,
                          target.most_needed_m, target.least_distance_m,
                          target.has_fit ? AsymptoteCell(target.fit) : Cell(std::string())});
  }
  Section section{.key = "verdict", .title = "Verdict"};
  if (!study.question.empty()) section.paragraphs.push_back(study.question);
  section.tables.push_back(std::move(table));
  for (const TargetResult& target : targets) {
    const bool has_curve = target.has_fit && !std::isnan(target.fit.curve.middle_m);
    if (!has_curve || section.charts.size() >= kMaxCharts) continue;
    section.charts.push_back(ProbabilityChart(target.name, target.inspections, target.fit));
  }
  return section;
}

std::string DrawnText(const std::map<std::string, Json>& drawn) {
  std::string text;
  for (const auto& [name, value] : drawn) {
    if (!text.empty()) text += ", ";
    text += name + " " + (value.is_string() ? value.get<std::string>() : value.dump());
  }
  return text;
}

// Those that were missed first, then by what is to spare, then by their place in the recipe.
bool IsWorse(const Observation& one, const Observation& other) {
  const auto key = [](const Observation& each) {
    return std::tuple(each.object->is_detected, each.object->spare_m(), each.approach->scenario);
  };
  return key(one) < key(other);
}

std::vector<std::pair<std::string, std::string>> FactsOfStudy(const StudySpec& study,
                                                              const StudyResult& result) {
  const Json& identity = result.identity;
  const auto text = [&](const char* key) { return identity.at(key).get<std::string>(); };
  std::string bases;
  for (const Json& hash : identity.at("bases_xxh3")) {
    if (!bases.empty()) bases += ", ";
    bases += hash.get<std::string>();
  }
  const DetectionRule& rule = study.detect.rule;
  const BrakingSpec& braking = study.detect.braking;
  return {
      {"Study", ShownPath(study.file) + " (" + text("study_xxh3") + ")"},
      {"Recipe", ShownPath(study.recipe) + " (" + text("recipe_xxh3") + ")"},
      {"Bases", bases},
      {"Approaches", NumberText(result.approaches.size())},
      {"Detected", NumberText(rule.min_points) + " points in " + NumberText(rule.min_frames) +
                       " of " + NumberText(rule.of_frames) + " frames"},
      {"Braking", NumberText(braking.reaction_s) + " s, " + NumberText(braking.deceleration_mps2) +
                      " m/s2, margin " + NumberText(braking.margin_m) + " m"},
      {"Simulated by", text("version") + ", Embree " + text("embree") + ", " + text("isa")}};
}

}  // namespace

Section YardsticksSection() {
  Table table;
  table.key = "yardsticks";
  table.title = "Published distances of detection";
  table.note = "Other objects, places and weather than here: for the order of magnitude.";
  table.is_open = true;
  table.columns = {{"what", "What", ""},
                   {"who", "By", ""},
                   {"distance_m", "Distance", "m"},
                   {"how", "How measured", ""},
                   {"source", "Source", ""}};
  for (const Json& row : Json::parse(kYardsticks)) {
    table.rows.push_back({row.at("what").get<std::string>(), row.at("who").get<std::string>(),
                          row.at("distance_m").get<double>(), row.at("how").get<std::string>(),
                          row.at("source").get<std::string>()});
  }
  return {.key = "yardsticks", .title = "The driver, and others", .tables = {std::move(table)}};
}

std::string FolderOfWorst(std::uint32_t scenario) {
  return "worst/" + FrameDigits(scenario);
}

std::vector<Observation> WorstOf(const std::vector<Observation>& observations) {
  constexpr std::size_t kMostWorst = 10;
  std::vector<Observation> worst;
  std::ranges::copy_if(observations, std::back_inserter(worst),
                       [](const Observation& each) { return !each.object->is_undecided(); });
  std::ranges::sort(worst, IsWorse);
  worst.resize(std::min(worst.size(), kMostWorst));
  return worst;
}

Section WorstSection(const std::vector<Observation>& worst, const std::string& folder) {
  Table table;
  table.key = "worst";
  table.title = "The worst approaches";
  table.note =
      "Not detected, or with the least to spare. The command makes its frames and opens "
      "the one in which it is detected, or that of the closest point.";
  table.is_open = true;
  table.columns = {
      {"scenario", "Scenario", ""}, {"object", "Object", ""}, {"distance_m", "Detected at", "m"},
      {"needed_m", "Needed", "m"},  {"drawn", "Drawn", ""},   {"command", "Command", ""}};
  for (const Observation& each : worst) {
    const StudiedObject& object = *each.object;
    const std::string place = folder + "/" + FolderOfWorst(each.approach->scenario);
    std::string drawn = DrawnText(each.approach->drawn);
    if (!object.drawn.empty()) drawn += (drawn.empty() ? "" : "; ") + DrawnText(object.drawn);
    table.rows.push_back({std::uint64_t{each.approach->scenario}, object.name, object.distance_m,
                          object.needed_m, std::move(drawn),
                          "railcast-generate sequence " + place + "/scenario.resolved.json --out " +
                              place + "/frames --frames " + std::to_string(object.frame + 1) +
                              " && railcast-view " + place + "/frames --frame " +
                              std::to_string(object.frame)});
  }
  return {.key = "worst", .title = "Where it fails", .tables = {std::move(table)}};
}

Report MakeStudyReport(const StudySpec& study,
                       const StudyResult& result,
                       const std::vector<Observation>& observations,
                       const std::string& command) {
  Report report;
  report.title = "Study " + study.file.stem().string();
  report.command = command;
  report.facts = FactsOfStudy(study, result);
  const std::vector<TargetResult> targets = ResultsOf(observations);
  for (const TargetResult& target : targets) {
    report.headlines.push_back({.title = target.name + ": 0.9 with 95 % confidence at",
                                .unit = "m",
                                .value = target.has_fit ? target.fit.d90_95_m : kUnknownFigure});
  }
  const std::vector<Factor> factors = FactorsOf(observations);
  report.sections = {TargetsSection(study, targets),
                     FactorsSection(WeighFactors(observations, factors), observations.size()),
                     ConditionsSection(observations, factors), YardsticksSection()};
  return report;
}

}  // namespace railcast
