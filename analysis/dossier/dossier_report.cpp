#include "analysis/dossier/dossier_report.h"

#include <utility>

#include "analysis/limits/limit_sections.h"
#include "analysis/study/study_factors.h"
#include "analysis/study/study_report.h"
#include "core/base/error.h"
#include "core/base/text.h"

namespace railcast {
namespace {

std::vector<Headline> VerdictHeadlines(const std::vector<TargetResult>& targets) {
  std::vector<Headline> headlines;
  for (const TargetResult& target : targets) {
    headlines.push_back(
        {.title = target.name + ": detected in time", .unit = "", .value = AnswerOf(target)});
    headlines.push_back({.title = target.name + ": 0.9 with 95 % confidence at",
                         .unit = "m",
                         .value = target.d90_95_m});
    headlines.push_back(
        {.title = target.name + ": needed, at most", .unit = "m", .value = target.most_needed_m});
  }
  return headlines;
}

}  // namespace

Report MakeDossier(const FinishedStudy& study,
                   const std::vector<ScenarioSpec>& sample,
                   const ModelError& error,
                   const std::string& command) {
  const std::vector<Observation> observations = ObservationsOf(study.result.approaches);
  if (observations.empty()) {
    throw InputError(ShownPath(study.directory) +
                     ": no approach comes to an object in the way: nothing can be detected");
  }
  const std::vector<TargetResult> targets = TargetsOf(observations);
  const std::vector<Factor> factors = FactorsOf(observations);
  Report report{
      .title = study.spec.question.empty() ? "Dossier of a study" : study.spec.question,
      .command = command,
      .headlines = VerdictHeadlines(targets),
      .sections = {VerdictSection(targets), ScopeSection(study, sample), ModelErrorSection(error),
                   SensorSection(sample), LimitsSection(sample, study.spec.detector.has_value()),
                   FactorsSection(WeighFactors(observations, factors), observations.size()),
                   ConditionsSection(observations, factors), YardsticksSection(targets),
                   CredibilitySection(), TraceabilitySection(study), SignaturesSection()}};
  Section placement = PlacementSection(observations, factors, study.recipe);
  if (!placement.tables.empty()) {
    report.sections.insert(report.sections.begin() + 1, std::move(placement));
  }
  if (study.spec.detector) {
    report.sections.insert(report.sections.begin() + 1,
                           StudyAlarmsSection(study.spec, study.result.approaches));
  }
  return report;
}

}  // namespace railcast
