#include "analysis/extras/study/study_report.h"

#include <algorithm>
#include <nlohmann/json.hpp>
#include <optional>
#include <utility>

#include "analysis/detectability/detect_report.h"
#include "analysis/extras/detectors/alarm_report.h"
#include "analysis/extras/detectors/evaluate_report.h"
#include "analysis/extras/study/kept_files.h"
#include "analysis/report/words.h"
#include "analysis/stats/certificate_section.h"
#include "core/base/join.h"
#include "core/base/text.h"

namespace railcast {

extern const char* const kYardsticks;

namespace {

std::string DrawnText(const std::map<std::string, Json>& drawn) {
  std::string text;
  for (const auto& [name, value] : drawn) {
    if (!text.empty()) text += ", ";
    text += name + " " + (value.is_string() ? value.get<std::string>() : value.dump());
  }
  return text;
}

// What was missed is worst, then what has least to spare, then what comes first in the recipe.
bool IsWorse(const Observation& one, const Observation& other) {
  const auto key = [](const Observation& each) {
    return std::tuple(each.object->is_detected, each.object->spare_m(), each.approach->scenario);
  };
  return key(one) < key(other);
}

std::string SeenText(const StudySpec& study) {
  const DetectionRule& rule = study.detect.rule;
  const std::string frames =
      NumberText(rule.min_frames) + " of " + NumberText(rule.of_frames) + " frames";
  if (!study.detector) return NumberText(rule.min_points) + " points in " + frames;
  return ClusterDetectorText(*study.detector) + "; in " + frames;
}

// Each target that a driver's distance is published for.
Table DriverTable(const std::vector<TargetResult>& targets, const Json& yardsticks) {
  Table table = TableOf(kStudyWords, "beside_driver");
  for (const TargetResult& target : targets) {
    for (const Json& row : yardsticks) {
      const auto what = row.at("what").get<std::string>();
      if (row.at("who") != "driver" || (what != target.type && what != target.name)) continue;
      const auto driver_m = row.at("distance_m").get<double>();
      table.rows.push_back({target.name, target.d90_95_m, driver_m,
                            100.0 * target.d90_95_m / driver_m,
                            row.at("source").get<std::string>()});
    }
  }
  return table;
}

}  // namespace

std::vector<std::pair<std::string, std::string>> FactsOfStudy(const StudySpec& study,
                                                              const StudyRecord& identity,
                                                              std::size_t num_approaches) {
  const BrakingSpec& braking = study.detect.braking;
  return {
      {"Study", ShownPath(study.file) + " (" + identity.study_hash + ")"},
      {"Recipe", ShownPath(study.recipe) + " (" + identity.recipe_hash + ")"},
      {"Bases", Join(identity.base_hashes)},
      {"Approaches", NumberText(num_approaches)},
      {"Asked about", study.ObjectsText()},
      {"Detected", SeenText(study)},
      {"Braking", NumberText(braking.reaction_s) + " s, " + NumberText(braking.deceleration_mps2) +
                      " m/s2, margin " + NumberText(braking.margin_m) + " m"},
      {"Simulated by", identity.version + ", Embree " + identity.embree + ", " + identity.isa}};
}

Section YardsticksSection(const std::vector<TargetResult>& targets) {
  const Json yardsticks = Json::parse(kYardsticks);
  Table table = TableOf(kStudyWords, "yardsticks");
  for (const Json& row : yardsticks) {
    table.rows.push_back({row.at("what").get<std::string>(), row.at("who").get<std::string>(),
                          row.at("distance_m").get<double>(), row.at("how").get<std::string>(),
                          row.at("source").get<std::string>()});
  }
  Section section = SectionOf(kStudyWords, "yardsticks");
  Table beside_driver = DriverTable(targets, yardsticks);
  if (!beside_driver.rows.empty()) section.tables.push_back(std::move(beside_driver));
  section.tables.push_back(std::move(table));
  return section;
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
  Table table = TableOf(kStudyWords, "worst");
  for (const Observation& each : worst) {
    const StudiedObject& object = *each.object;
    const std::string place = folder + "/" + KeptFolder(kWorstFolder, each.approach->scenario);
    std::string drawn = DrawnText(each.approach->drawn);
    if (!object.drawn.empty()) drawn += (drawn.empty() ? "" : "; ") + DrawnText(object.drawn);
    table.rows.push_back({std::uint64_t{each.approach->scenario}, object.name, object.distance_m,
                          object.needed_m, std::move(drawn),
                          "railcast-generate sequence " + place + "/scenario.resolved.json --out " +
                              place + "/frames --frames " + std::to_string(object.frame + 1) +
                              " && railcast-view " + place + "/frames --frame " +
                              std::to_string(object.frame)});
  }
  Section section = SectionOf(kStudyWords, "worst");
  section.tables = {std::move(table)};
  return section;
}

bool SaysNothing(const Section& section) {
  return section.tables.empty() && section.paragraphs.empty();
}

Report MakeStudyReport(const StudySpec& study,
                       const Json& recipe,
                       const StudyResult& result,
                       const std::vector<Observation>& observations,
                       const std::string& command) {
  Report report{.title = study.question.empty() ? "A study of detection" : study.question,
                .command = command,
                .facts = FactsOfStudy(study, result.identity, result.approaches.size())};
  const std::vector<TargetResult> targets = TargetsOf(observations);
  report.headlines = VerdictHeadlines(targets);
  const std::vector<Factor> factors = FactorsOf(observations);
  const std::vector<FactorWeight> weights = WeighFactors(observations, factors);
  const std::vector<const Factor*> in_table = study.table.empty()
                                                  ? LargestFactors(observations, factors, weights)
                                                  : NamedFactors(study.table, factors);
  const std::optional<RunCertificate> certificate = CertificateOfStudy(result);
  if (certificate) AddCertificateHeadlines(*certificate, report);
  report.sections = {VerdictSection(targets),
                     TableSection(observations, in_table),
                     StudyCertificateSection(certificate),
                     PlacementSection(observations, factors, in_table, recipe),
                     FactorsSection(weights, observations.size()),
                     ConditionsSection(observations, factors, in_table),
                     YardsticksSection(targets)};
  if (study.detector) {
    report.sections.insert(report.sections.begin() + 2,
                           StudyAlarmsSection(study, result.approaches));
  }
  std::erase_if(report.sections, &SaysNothing);
  if (!study.detector) return report;
  std::uint64_t num_alarms = 0;
  double driven_m = 0.0;
  for (const ApproachRecord& approach : result.approaches) {
    num_alarms += approach.alarms->alarms.size();
    driven_m += approach.alarms->driven_m;
  }
  report.headlines.push_back(
      {.title = "False alarms per km", .unit = "1/km", .value = AlarmsPerKm(num_alarms, driven_m)});
  return report;
}

}  // namespace railcast
