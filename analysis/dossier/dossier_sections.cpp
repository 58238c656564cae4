#include "analysis/dossier/dossier_report.h"

#include <algorithm>
#include <nlohmann/json.hpp>
#include <utility>

#include "analysis/report/provenance.h"
#include "core/base/text.h"

namespace railcast {

extern const char* const kCredibility;

Section CredibilitySection() {
  Table table{
      .key = "credibility",
      .title = "Questions of credibility",
      .note =
          "After the properties that Regulation (EU) 2022/1426, Annex III part 4, and the NATM "
          "guidelines of UNECE ask of simulation toolchains, in our words. Open questions are for "
          "whoever files this.",
      .columns = ColumnsOf("property: Property; question: Question; state: State; answer: Answer"),
      .is_open = true};
  for (const Json& row : Json::parse(kCredibility)) {
    const auto answer = row.at("answer").get<std::string>();
    table.rows.push_back({row.at("property").get<std::string>(),
                          row.at("question").get<std::string>(),
                          std::string(answer.empty() ? "open" : "answered"), answer});
  }
  return {.key = "credibility", .title = "Credibility", .tables = {std::move(table)}};
}

Section TraceabilitySection(const FinishedStudy& study) {
  Table table{.key = "traceability",
              .title = "What the figures depend on",
              .columns = ColumnsOf("what: What; value: Value"),
              .is_open = true};
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
  std::string bases;
  for (const std::string& hash : identity.base_hashes) {
    bases += (bases.empty() ? "" : ", ") + hash;
  }
  add("Bases", bases);
  const std::string& files = identity.files_hash;
  add("Other files", files.empty() ? "none" : files);
  const auto& approaches = study.result.approaches;
  const auto seeds = std::ranges::minmax(approaches, {}, &ApproachRecord::seed);
  add("Approaches", NumberText(approaches.size()) + ", seeds " + NumberText(seeds.min.seed) +
                        " to " + NumberText(seeds.max.seed) +
                        "; each line of approaches.jsonl has its own");
  add("To make it again", "railcast-analyze study STUDY.json --out DIR --isa " + identity.isa +
                              ", with the study and the recipe of the hashes above (inputs/ has "
                              "copies); approaches.jsonl then has the same bytes");
  return {.key = "traceability", .title = "Traceability", .tables = {std::move(table)}};
}

Section SignaturesSection() {
  Table table{.key = "signatures",
              .title = "Signatures",
              .columns = ColumnsOf("role: Role; name: Name; date: Date; signature: Signature"),
              .is_open = true};
  for (const char* const role : {"Made by", "Checked by", "Assessed by"}) {
    table.rows.push_back({std::string(role), std::string(), std::string(), std::string()});
  }
  return {.key = "signatures", .title = "Signatures", .tables = {std::move(table)}};
}

}  // namespace railcast
