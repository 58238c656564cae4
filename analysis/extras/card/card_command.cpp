#include <iostream>
#include <memory>

#include "analysis/analysis_extras.h"
#include "analysis/commands.h"
#include "analysis/extras/card/dataset_card.h"
#include "analysis/extras/card/dataset_overview.h"
#include "analysis/report/formats.h"
#include "analysis/report/output.h"
#include "analysis/report/provenance.h"
#include "core/base/error.h"
#include "core/base/text.h"
#include "core/extras/recipe/dataset_verification.h"
#include "core/io/run/run_folder.h"
#include "core/io/write_file.h"
#include "core/program/version.h"

namespace railcast {
namespace {

namespace fs = std::filesystem;

constexpr const char* kCardFile = "README.md";

struct CardOptions {
  fs::path dataset;
  std::string licence;
  ReportOutput output;
};

void CheckOut(const fs::path& out) {
  CheckReportFolder(out, {"card.json", kCardFile});
  // People write files of this name, too.
  const fs::path readme = out / kCardFile;
  if (fs::exists(readme) && !ReadFileWhole(readme).starts_with("# Data set ")) {
    throw InputError(ShownPath(readme) + ": must be absent or an earlier card, which is replaced");
  }
}

int RunCard(const CardOptions& options, const std::string& command_line) {
  const fs::path& out = options.output.out;
  if (!out.empty()) CheckOut(out);
  Report report = MakeDatasetCard(options.dataset, options.licence, command_line);
  for (const auto& fact : MakerFacts(ProgramVersion())) report.facts.push_back(fact);
  if (!out.empty()) {
    MakeFolders(out);
    WriteFileWhole(out / kCardFile, ReportMarkdown(report));
  }
  EmitReport(report, options.output, "card");
  if (!out.empty() && !options.output.is_json) {
    std::cout << kCardFile << " in " << ShownPath(out) << "\n" << std::flush;
  }
  return kExitSuccess;
}

void AddCard(ProgramOptions& app, ProgramCommand& command) {
  const auto options = std::make_shared<CardOptions>();
  ProgramOptions card = app.AddCommand("card",
                                       "Write the card of a data set: pictures, parts, classes, "
                                       "recipe, licence and limits, as README.md and page");
  card.AddOption("DATASET", options->dataset,
                 "Folder that railcast-generate dataset or merge made, whole and finished")
      .Required()
      .Check(NonEmpty());
  card.AddOption("--licence", options->licence,
                 "Licence under which the data set is given away, such as CC-BY-4.0")
      .Check(NonEmpty());
  AddReportOptions(card, options->output);
  card.WhenParsed([&command, options] {
    command = [options](const std::string& line) { return RunCard(*options, line); };
  });
}

MeasuredSource OpenDataset(const std::filesystem::path& directory) {
  const DatasetContent content = ReadDatasetContent(directory);
  MeasuredSource whole{.source = directory, .recordings = FinishedSequences(directory, content)};
  if (!content.shard.is_whole()) {
    whole.kind = "shard " + ShardText(content.shard) + " of a data set";
    return whole;
  }
  whole.kind = "data set";
  const DatasetOverview overview = ReadDatasetOverview(directory);
  whole.data_hash = overview.data_hash;
  whole.section = [overview](const std::string& suffix) {
    return MakeDatasetSection(overview, suffix);
  };
  return whole;
}

}  // namespace

void AddCard(AnalysisExtras& extras) {
  extras.commands["card"] = AddCard;
  extras.open_dataset = OpenDataset;
}

}  // namespace railcast
