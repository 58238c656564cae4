#include "analysis/extras/dossier/dossier_report.h"

#include <algorithm>
#include <boost/algorithm/string/replace.hpp>
#include <cmath>
#include <nlohmann/json.hpp>
#include <optional>
#include <set>
#include <utility>

#include "analysis/extras/study/study_factors.h"
#include "analysis/extras/study/study_report.h"
#include "analysis/limits/limit_sections.h"
#include "analysis/report/program_output.h"
#include "analysis/report/provenance.h"
#include "analysis/report/words.h"
#include "analysis/stats/certificate_section.h"
#include "core/base/error.h"
#include "core/base/input_file.h"
#include "core/base/join.h"
#include "core/base/text.h"
#include "core/io/write_file.h"
#include "core/program/command_line.h"

namespace railcast {

extern const char* const kPrintCss;
extern const char* const kCredibility;

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
  const std::vector<FactorWeight> weights = WeighFactors(observations, factors);
  const std::vector<const Factor*> in_table = study.spec.table.empty()
                                                  ? LargestFactors(observations, factors, weights)
                                                  : NamedFactors(study.spec.table, factors);
  const std::optional<RunCertificate> certificate = CertificateOfStudy(study.result);
  Report report{
      .title = study.spec.question.empty() ? "Dossier of a study" : study.spec.question,
      .command = command,
      .headlines = VerdictHeadlines(targets),
      .sections = {VerdictSection(targets), TableSection(observations, in_table),
                   PlacementSection(observations, factors, in_table, study.recipe),
                   ScopeSection(study, sample), ModelErrorSection(error),
                   StudyCertificateSection(certificate), SensorSection(sample),
                   LimitsSection(sample, study.spec.detector.has_value()),
                   FactorsSection(weights, observations.size()),
                   ConditionsSection(observations, factors, in_table), YardsticksSection(targets),
                   CredibilitySection(), TraceabilitySection(study), SignaturesSection()}};
  if (certificate) AddCertificateHeadlines(*certificate, report);
  if (study.spec.detector) {
    report.sections.insert(report.sections.begin() + 2,
                           StudyAlarmsSection(study.spec, study.result.approaches));
  }
  std::erase_if(report.sections, &SaysNothing);
  return report;
}

std::string WithColoredMarks(const std::string& html) {
  const std::string ink = "#17202a";
  std::string text;
  std::size_t from = 0;
  for (std::size_t at = html.find("<defs>"); at != std::string::npos;
       at = html.find("<defs>", from)) {
    const std::size_t body = html.find("</defs>", at);
    const std::size_t end = html.find("</svg>", at);
    Check(body < end && end != std::string::npos, "a drawing ends after its definitions");
    const std::string defs = html.substr(at, body - at);
    std::string marks = html.substr(body, end - body);
    text += boost::replace_all_copy(html.substr(from, at - from), "currentColor", ink) +
            boost::replace_all_copy(defs, "currentColor", ink);
    std::set<std::string> colors;
    for (std::size_t use = marks.find("<use "); use != std::string::npos;
         use = marks.find("<use ", use + 1)) {
      const std::size_t color = marks.find("color='#", use);
      if (color == std::string::npos || color > marks.find("/>", use)) continue;
      const std::string name = marks.substr(color + 8, 6);
      marks.insert(marks.find("-gp", use), "-" + name);
      colors.insert(name);
    }
    for (const std::string& color : colors) {
      std::string colored = boost::replace_all_copy(defs.substr(6), "-gp", "-" + color + "-gp");
      text += boost::replace_all_copy(colored, "currentColor", "#" + color);
    }
    text += boost::replace_all_copy(marks, "currentColor", ink);
    from = end;
  }
  return text + boost::replace_all_copy(html.substr(from), "currentColor", ink);
}

void PrintPage(const std::filesystem::path& page, const std::filesystem::path& pdf) {
  std::string html = WithColoredMarks(ReadFileWhole(page));
  const std::size_t head = html.find("</head>");
  Check(head != std::string::npos, "a page has a head");
  html.insert(head, "<style>" + std::string(kPrintCss) + "</style>");
  const ReportScratch scratch;
  const std::filesystem::path file = scratch.path() / "page.html";
  WriteFileWhole(file, html);
  WriteFileWhole(
      pdf, ProgramOutput("weasyprint --quiet " + ShellWord(file.string()) + " -", "weasyprint"));
}

Section CredibilitySection() {
  Section section = SectionOf(kDossierWords, "credibility");
  for (const Json& rules : Json::parse(kCredibility)) {
    Table table{.key = rules.at("key").get<std::string>(),
                .title = rules.at("title").get<std::string>(),
                .note = rules.at("note").get<std::string>(),
                .columns = ColumnsOf(
                    "property: Property; question: Question; state: State; answer: Answer"),
                .is_open = true};
    for (const Json& row : rules.at("questions")) {
      const auto answer = row.at("answer").get<std::string>();
      table.rows.push_back({row.at("property").get<std::string>(),
                            row.at("question").get<std::string>(),
                            std::string(answer.empty() ? "open" : "answered"), answer});
    }
    section.tables.push_back(std::move(table));
  }
  return section;
}

namespace {

// As --certify takes it.
std::string CertifyText(std::optional<double> share) {
  constexpr double kPlaces = 1e8;  // Places of the percent, so that 7% is not 7.000000000000001%.
  return share ? NumberText(std::round(kPlaces * 100.0 * *share) / kPlaces) + "%" : "off";
}

}  // namespace

Section TraceabilitySection(const FinishedStudy& study) {
  Table table = TableOf(kDossierWords, "traceability");
  const auto add = [&](const std::string& what, const std::string& value) {
    table.rows.push_back({what, value});
  };
  const StudyRecord& identity = study.result.identity;
  add("Made by",
      "railcast " + identity.version + ", Embree " + identity.embree + ", " + identity.isa);
  add("Machine", ProcessorName() +
                     ", for the measured errors and this dossier; approaches have the same bytes "
                     "on every processor with " +
                     identity.isa);
  add("Study", identity.study_hash);
  add("Asked about", study.spec.ObjectsText());
  add("Recipe", identity.recipe_hash);
  add("Bases", Join(identity.base_hashes));
  const std::string& files = identity.files_hash;
  add("Other files", files.empty() ? "none" : files);
  const auto& approaches = study.result.approaches;
  const auto seeds = std::ranges::minmax(approaches, {}, &ApproachRecord::seed);
  add("Approaches", NumberText(approaches.size()) + ", seeds " + NumberText(seeds.min.seed) +
                        " to " + NumberText(seeds.max.seed) +
                        "; each line of approaches.jsonl has its own");
  add("To make it again", "railcast-analyze study STUDY.json --out DIR --isa " + identity.isa +
                              " --certify " + CertifyText(identity.certify) +
                              ", with the study and the recipe of the hashes above (inputs/ has "
                              "copies); approaches.jsonl then has the same bytes");
  Section section = SectionOf(kDossierWords, "traceability");
  section.tables = {std::move(table)};
  return section;
}

Section SignaturesSection() {
  Table table = TableOf(kDossierWords, "signatures");
  for (const char* const role : {"Made by", "Checked by", "Assessed by"}) {
    table.rows.push_back({std::string(role), std::string(), std::string(), std::string()});
  }
  Section section = SectionOf(kDossierWords, "signatures");
  section.tables = {std::move(table)};
  return section;
}

}  // namespace railcast
