#include <iomanip>
#include <iostream>
#include <memory>
#include <optional>
#include <sstream>
#include <string>
#include <vector>

#include "analysis/analysis_extras.h"
#include "analysis/commands.h"
#include "analysis/extras/study/kept_files.h"
#include "analysis/extras/study/rare_study.h"
#include "analysis/extras/study/run_study.h"
#include "analysis/extras/study/study_directory.h"
#include "analysis/extras/study/study_report.h"
#include "analysis/report/output.h"
#include "analysis/report/provenance.h"
#include "core/base/input_file.h"
#include "core/base/text.h"
#include "core/certify/certifier.h"
#include "core/extras/recipe/scenario_draw.h"
#include "core/extras/recipe/shard.h"
#include "core/io/run/run_folder.h"
#include "core/program/progress_line.h"
#include "core/program/stop_signals.h"
#include "core/program/version.h"

namespace railcast {
namespace {

namespace fs = std::filesystem;

struct StudyOptions {
  fs::path study;
  std::vector<std::string> table;
  StudyChoices choices;
  std::string shard;
  std::string certify = "1%";
  bool has_certify = false;
  bool is_rare = false;
  std::optional<double> unseen;
  ReportOutput output;
};

std::string Summary(const StudyResult& result) {
  std::ostringstream text;
  text << std::fixed << std::setprecision(1) << "made " << result.num_made << " approaches in "
       << result.elapsed_s << " s";
  if (result.num_made > 0) {
    text << ", tracing objects in " << result.num_traced << " of " << result.num_frames
         << " frames";
  }
  text << "; " << result.approaches.size() << " of " << result.num_approaches << " are done\n";
  return text.str();
}

// A study is certified unless the command line says otherwise; one that was begun, also as shards,
// goes on as it was begun.
std::optional<double> UsualCertify(const StudyChoices& choices) {
  std::vector<fs::path> folders = {choices.directory};
  folders.insert(folders.end(), choices.shards.begin(), choices.shards.end());
  for (const fs::path& folder : folders) {
    if (fs::exists(folder / kStudyFile)) return ReadStudyRecord(folder).certify;
  }
  return CertifiedShareOf("1%");
}

int Interrupted() {
  std::cerr << "interrupted; the same command continues\n";
  return kExitInterrupted;
}

StudyHooks HooksOf(const ProgressLine& line) {
  return {[&line](std::uint32_t num_done, std::uint32_t num_approaches) {
            line.Show("approaches", static_cast<double>(num_done) / num_approaches);
          },
          StopRequested};
}

int RunRareCommand(const StudyOptions& options,
                   const StudySpec& study,
                   const ScenarioDrawer& drawer,
                   const std::string& command_line) {
  if (!options.shard.empty() || !options.choices.shards.empty()) {
    throw InputError("--rare: has no shards: each stage goes by the one before it");
  }
  if (options.has_certify || !options.table.empty()) {
    throw InputError("--rare: must be without --certify and --table: it compares rungs itself");
  }
  const ProgressLine line;
  auto rare = RunRareStudy(study, drawer, options.choices, HooksOf(line));
  line.End();
  if (!rare) return Interrupted();
  std::erase_if(rare->approaches, [&](const ApproachRecord& approach) {
    const RareRun& run = rare->run;
    return run.figure.correction.num > 0 && !run.trials[approach.scenario].is_pair;
  });
  const std::vector<Observation> worst = WorstOf(ObservationsOf(rare->approaches));
  KeepFiles(
      study, [&](std::uint32_t number) { return DrawRare(*rare, drawer, number); }, worst, {},
      options.output.out);
  Report report{.title = study.question.empty() ? "Rare failures" : study.question,
                .command = command_line,
                .facts = FactsOfStudy(study, rare->identity, rare->run.trials.size())};
  report.headlines = {{.title = "Not detected in time", .value = rare->run.figure.probability}};
  report.sections = RareSections(*rare);
  report.sections.push_back(WorstSection(worst, ShownPath(options.output.out)));
  for (const auto& fact : MakerFacts(ProgramVersion())) report.facts.push_back(fact);
  EmitReport(report, options.output, "report");
  return kExitSuccess;
}

void GiveUnseen(double unseen, StudySpec& study) {
  if (!study.rare) throw InputError("--unseen: must be with --rare");
  const double least = LeastUnseen(*study.rare);
  if (!(unseen >= least && unseen <= kMostUnseen)) {
    throw InputError("--unseen: must be from " + NumberText(least) + " to " +
                     NumberText(kMostUnseen) + Got(unseen));
  }
  study.rare->unseen = unseen;
}

int RunStudyCommand(StudyOptions options, const std::string& command_line) {
  if (options.output.out.empty()) {
    throw InputError("--out: missing: the folder of the study, in which it can be continued");
  }
  CheckIsOutside("--out", options.output.out, true);
  CheckTable(options.table);
  if (!options.table.empty() && !options.choices.shard.is_whole()) {
    throw InputError("--table: must be without --shard: a shard has no report");
  }
  StudySpec study = ReadStudy(options.study);
  study.table = options.table;
  if (options.is_rare && !study.rare) study.rare.emplace();
  if (options.unseen) GiveUnseen(*options.unseen, study);
  const Recipe recipe = ReadStudyRecipe(study);
  const ScenarioDrawer drawer(recipe);
  CatchStopSignals();
  options.choices.directory = options.output.out;
  if (study.rare) return RunRareCommand(options, study, drawer, command_line);
  options.choices.certify =
      options.has_certify ? CertifiedShareOf(options.certify) : UsualCertify(options.choices);
  const ProgressLine line;
  const StudyResult result = RunStudy(study, drawer, options.choices, HooksOf(line));
  line.End();
  if (!options.output.is_json) std::cout << Summary(result);
  if (!result.is_complete()) return Interrupted();
  if (!options.choices.shard.is_whole()) {
    std::cout << "shard " << options.shard << " is complete; --shards joins all of them\n";
    return kExitSuccess;
  }
  const std::vector<Observation> observations = ObservationsOf(result.approaches);
  if (observations.empty()) {
    throw InputError(ShownPath(options.study) +
                     ": no approach comes to an object in the way: nothing can be detected");
  }
  const std::vector<Observation> worst = WorstOf(observations);
  KeepFiles(
      study, [&](std::uint32_t number) { return drawer.Draw(number); }, worst,
      SampleOf(observations), options.output.out);
  Report report = MakeStudyReport(study, Json::parse(ReadFileWhole(study.recipe)), result,
                                  observations, command_line);
  report.sections.insert(report.sections.end() - 1,
                         WorstSection(worst, ShownPath(options.output.out)));
  for (const auto& fact : MakerFacts(ProgramVersion())) report.facts.push_back(fact);
  EmitReport(report, options.output, "report");
  return kExitSuccess;
}

void AddStudy(ProgramOptions& app, ProgramCommand& command) {
  const auto options = std::make_shared<StudyOptions>();
  ProgramOptions study = app.AddCommand(
      "study",
      "Simulate the approaches that a recipe draws, and report with which probability objects in "
      "the way are detected at which distance");
  study
      .AddOption("STUDY", options->study, "Study file: the recipe and the question (docs/study.md)")
      .Required()
      .Check(NonEmpty());
  AddReportOptions(study, options->output);
  AddTable(study, options->table);
  const Option shard =
      study
          .AddOption("--shard", options->shard, "I/N: simulate only the I-th of every N approaches")
          .Check({ShardRule, ""});
  study
      .AddOption("--shards", options->choices.shards,
                 "Folders of all shards, to report on them as one study")
      .Excludes(shard);
  study
      .AddOption("--certify", options->certify,
                 "Share of the frames' time, such as 1%, in which some firings near the objects "
                 "are simulated again on rung reference to estimate the numerical error; or off")
      .ShowDefault();
  study.AddFlag("--rare", options->is_rare,
                "Estimate how often something in the way is not detected in time, however rare");
  study.AddOption(
      "--unseen", options->unseen,
      "With --rare: how rare a kind of failure may be, such as 1e-3, that is met although "
      "no search leads to it");
  AddThreads(study, options->choices.num_threads);
  AddIsa(study, options->choices.isa);
  study.WhenParsed([&command, options, study] {
    options->has_certify = study.is_given("--certify");
    if (!options->shard.empty()) options->choices.shard = ParseShard(options->shard).value();
    command = [options](const std::string& line) { return RunStudyCommand(*options, line); };
  });
}

}  // namespace

void AddStudy(AnalysisExtras& extras) {
  extras.commands["study"] = AddStudy;
  extras.verify_study = VerifyStudy;
}

}  // namespace railcast
