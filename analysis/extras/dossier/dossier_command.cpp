#include <iostream>
#include <memory>
#include <string>

#include "analysis/analysis_extras.h"
#include "analysis/commands.h"
#include "analysis/extras/dossier/dossier_report.h"
#include "analysis/extras/study/finished_study.h"
#include "analysis/extras/study/study_report.h"
#include "analysis/report/output.h"
#include "analysis/report/provenance.h"
#include "core/program/progress_line.h"
#include "core/program/version.h"

namespace railcast {
namespace {

struct DossierOptions {
  std::filesystem::path study;
  std::vector<std::string> table;
  int num_threads = 0;
  ReportOutput output;
};

int RunDossierCommand(const DossierOptions& options, const std::string& command_line) {
  CheckReportFolder(options.output.out, {"dossier.json", "dossier.pdf"});
  FinishedStudy study = ReadFinishedStudy(options.study);
  study.spec.table = options.table;
  // Wrong names are said before the error is measured, which takes minutes.
  static_cast<void>(
      NamedFactors(options.table, FactorsOf(ObservationsOf(study.result.approaches))));
  const std::vector<ScenarioSpec> sample = ReadSample(study);
  const ProgressLine line;
  const ModelError error = MeasureModelError(study, sample, options.num_threads, [&](double done) {
    line.Show("approaches on rung reference", done);
  });
  line.End();
  Report report = MakeDossier(study, sample, error, command_line);
  for (const auto& fact : MakerFacts(ProgramVersion())) report.facts.push_back(fact);
  EmitReport(report, options.output, "dossier");
  if (options.output.out.empty()) return kExitSuccess;
  PrintPage(options.output.out / "report.html", options.output.out / "dossier.pdf");
  if (!options.output.is_json) {
    std::cout << "dossier.pdf in " << ShownPath(options.output.out) << "\n";
  }
  return kExitSuccess;
}

void AddDossier(ProgramOptions& app, ProgramCommand& command) {
  const auto options = std::make_shared<DossierOptions>();
  ProgramOptions dossier = app.AddCommand(
      "dossier",
      "Write what an assessor files of a study: its verdict, scope, the measured error of its "
      "model, limits and traceability, as PDF, page and JSON");
  dossier.AddOption("STUDY_DIR", options->study, "Folder of a finished study")
      .Required()
      .Check(NonEmpty());
  AddReportOptions(dossier, options->output);
  AddTable(dossier, options->table);
  AddThreads(dossier, options->num_threads);
  dossier.WhenParsed([&command, options] {
    command = [options](const std::string& line) { return RunDossierCommand(*options, line); };
  });
}

}  // namespace

void AddDossier(AnalysisExtras& extras) {
  extras.commands["dossier"] = AddDossier;
}

}  // namespace railcast
