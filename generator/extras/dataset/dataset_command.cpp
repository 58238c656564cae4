#include <filesystem>
#include <iomanip>
#include <iostream>
#include <memory>
#include <optional>
#include <sstream>
#include <string>
#include <vector>

#include "core/base/join.h"
#include "core/base/text.h"
#include "core/extras/recipe/dataset_record.h"
#include "core/extras/recipe/recipe.h"
#include "core/io/record/read_record.h"
#include "core/io/run/dataset_files.h"
#include "core/io/run/run_folder.h"
#include "core/io/run/scenario_identity.h"
#include "core/io/write_file.h"
#include "core/program/progress_line.h"
#include "core/program/stop_signals.h"
#include "generator/commands.h"
#include "generator/extras/dataset/dataset_report.h"
#include "generator/extras/dataset/inserted_scenarios.h"
#include "generator/extras/dataset/run_dataset.h"
#include "generator/extras/empty_folder.h"
#include "generator/extras/recording_commands.h"
#include "generator/run/run_options.h"

namespace railcast {
namespace {

namespace fs = std::filesystem;

struct DatasetOptions {
  fs::path recipe;
  DatasetChoices choices;
  std::string shard = "1/1";
  bool has_scenarios_only = false;
  bool has_format = false;
};

// Writes the scenarios that frames would be made of, without frames; returns false if it is
// stopped.
bool WriteScenarios(const Recipe& recipe,
                    const ScenarioDrawer& drawer,
                    const DatasetOptions& options) {
  const fs::path& directory = options.choices.directory;
  fs::create_directories((directory / kSplitFiles[0]).parent_path());
  const Shard& shard = options.choices.shard;
  const std::uint32_t num_scenarios = shard.NumOf(recipe.num_scenarios);
  const ProgressLine progress;
  ScenarioReport report;
  PerPart<std::string> folders;
  for (std::uint32_t i = 0; i < num_scenarios; ++i) {
    if (StopRequested()) return false;
    progress.Show("scenarios", static_cast<double>(i) / num_scenarios);
    const std::uint32_t number = shard.ScenarioAt(i);
    const DrawnScenario drawn = drawer.Draw(number);
    report.Add(drawn.record);
    const auto split = ValueNamed<Split>(drawn.record.split).value();
    folders.at(static_cast<std::size_t>(split)) += SequenceFolderOf(number) + "\n";
    const fs::path folder = directory / SequenceFolderOf(number);
    const std::string name = drawn.run ? "plan.resolved.json" : "scenario.resolved.json";
    WriteScenarioFiles(IdentityOf(drawn.scenario), folder, name);
    std::cout << ShownPath(folder / name) << '\n';
  }
  progress.End();
  for (std::size_t i = 0; i < folders.size(); ++i) {
    WriteFileWhole(directory / kSplitFiles.at(i), folders[i]);
  }
  WriteFileWhole(directory / kReportFile, report.Write(recipe.split).dump(2) + "\n");
  std::cout << ShownLines(report.Text(recipe.split));
  return true;
}

// Makes the scenarios in an empty folder, which is empty again if they are not all written.
int RunScenarios(const Recipe& recipe, const DatasetOptions& options) {
  const ScenarioDrawer drawer(recipe);
  const FolderLock lock = LockEmptyFolder(options.choices.directory);
  const auto clear = [&] {
    for (const auto& entry : fs::directory_iterator(options.choices.directory)) {
      fs::remove_all(entry.path());
    }
  };
  CatchStopSignals();
  try {
    if (WriteScenarios(recipe, drawer, options)) return kExitSuccess;
  } catch (...) {
    clear();
    throw;
  }
  clear();
  std::cerr << "interrupted; the same command begins anew\n";
  return kExitInterrupted;
}

std::string SummaryOfRun(const Recipe& recipe,
                         const DatasetResult& result,
                         const DatasetOptions& options) {
  std::ostringstream text;
  text << std::fixed << std::setprecision(1);
  if (result.was_complete) {
    text << "already complete: nothing to do\n";
  } else {
    text << "made " << Amount(result.num_done - result.num_resumed, "scenarios, ")
         << Amount(result.num_frames, "frames in ") << result.elapsed_s << " s";
    if (result.num_frames > 0) {
      text << " (" << static_cast<double>(result.num_frames) / result.elapsed_s << " frames/s)";
    }
    if (result.num_resumed > 0) text << "; " << result.num_resumed << " were already there";
    text << "\n";
  }
  text << result.num_done << " of " << result.num_scenarios << " scenarios in "
       << ShownPath(options.choices.directory) << "\n";
  if (result.parts) text << PartsText(*result.parts, recipe.split);
  if (result.is_complete && !options.choices.shard.is_whole()) {
    text << "shard " << options.shard
         << " is complete; railcast-generate merge makes one data set of all\n";
  }
  return text.str();
}

/// Shows which scenario is being made, from the first one on.
class ScenarioProgress {
 public:
  void Show(std::uint32_t num_done, std::uint32_t num_scenarios, double done) {
    if (!line_) line_.emplace(done);
    line_->Show("scenario " + std::to_string(num_done + 1) + " of " + std::to_string(num_scenarios),
                done);
  }
  void End() {
    if (line_) line_->End();
  }

 private:
  std::optional<ProgressLine> line_;
};

// A data set is certified unless the command line says otherwise; one that was begun goes on as it
// was begun.
std::string UsualCertify(const DatasetChoices& choices) {
  const std::filesystem::path file = choices.directory / kDatasetFile;
  if (!std::filesystem::exists(file)) return "1%";
  const auto record = ReadRecord<DatasetRecord>(ReadFileWhole(file), ShownPath(file));
  if (!record.certify) return "off";
  // The shortest percentage that is the same share again.
  for (int num_digits = 1;; ++num_digits) {
    std::ostringstream percent;
    percent << std::setprecision(num_digits) << 100.0 * *record.certify << '%';
    if (num_digits == 17 || CertifiedShareOf(percent.str()) == record.certify) return percent.str();
  }
}

int RunDatasetCommand(DatasetOptions options) {
  const Recipe recipe = ReadRecipe(options.recipe, ReadRecordedBase);
  if (recipe.has_plans() && !options.has_format) options.choices.format = "same";
  if (!options.choices.must_certify) options.choices.certify = UsualCertify(options.choices);
  static_cast<void>(CertifiedShareOf(options.choices.certify));
  if (options.has_scenarios_only) return RunScenarios(recipe, options);
  // The folder can be continued however the program ends.
  CatchStopSignals();
  ScenarioProgress line;
  const DatasetHooks hooks = {[&](const DatasetProgress& progress) {
                                line.Show(progress.num_done, progress.num_scenarios,
                                          progress.done());
                              },
                              StopRequested};
  const DatasetResult result = RunDataset(recipe, options.choices, hooks);
  line.End();
  std::cerr << ShownLines(MendedText(result.changed));
  std::cout << SummaryOfRun(recipe, result, options);
  if (result.is_complete) return kExitSuccess;
  std::cerr << "interrupted; the same command continues\n";
  return kExitInterrupted;
}

struct MergeOptions {
  std::vector<std::filesystem::path> shards;
  std::filesystem::path out;
};

int RunMerge(const MergeOptions& options) {
  CheckIsOutside("--out", options.out, true);
  ScenarioProgress line;
  const std::uint32_t num_scenarios =
      MergeShards(options.shards, options.out, [&](std::uint32_t num_done, std::uint32_t num_all) {
        line.Show(num_done, num_all, static_cast<double>(num_done) / num_all);
      });
  line.End();
  std::cout << Amount(num_scenarios, "scenarios of ") << Amount(options.shards.size(), "shards in ")
            << ShownPath(options.out) << "\n";
  return kExitSuccess;
}

void AddDataset(ProgramOptions& app, ProgramCommand& command) {
  const auto options = std::make_shared<DatasetOptions>();
  ProgramOptions dataset = app.AddCommand("dataset", OwnProgramOf("dataset").description);
  dataset.AddOption("RECIPE", options->recipe, "Recipe file").Required().Check(NonEmpty());
  dataset.AddOption("--out", options->choices.directory, "Folder to write the data set to")
      .Required()
      .Check(NonEmpty());
  dataset
      .AddOption("--shard", options->shard,
                 "I/N: make only every N-th scenario, beginning with the I-th")
      .Check({ShardRule, ""});
  options->choices.certify = "1%";
  const std::size_t num_before = dataset.options().size();
  AddRunChoices(dataset, options->choices);
  const std::vector<Option> all = dataset.options();
  const Option scenarios_only =
      dataset.AddFlag("--scenarios-only", options->has_scenarios_only,
                      "Write the scenarios without frames, to a new or an empty folder, and report "
                      "their parts, bases, weathers, draws and objects");
  for (std::size_t i = num_before; i < all.size(); ++i) scenarios_only.Excludes(all[i]);
  dataset.Footer(
      "Exit status: 0 success, 1 bad input or failed run, 2 usage, 130 interrupted (the same\n"
      "command continues).");
  dataset.WhenParsed([&command, options, dataset] {
    CheckFields(options->choices.fields);
    options->choices.shard = ParseShard(options->shard).value();
    options->has_format = dataset.is_given("--format");
    options->choices.must_certify = dataset.is_given("--certify");
    command = [options](const std::string&) { return RunDatasetCommand(*options); };
  });
}

void AddMerge(ProgramOptions& app, ProgramCommand& command) {
  const auto options = std::make_shared<MergeOptions>();
  ProgramOptions merge = app.AddCommand("merge", OwnProgramOf("merge").description);
  merge.AddOption("SHARD", options->shards, "Folders that dataset --shard made, all of them")
      .Required()
      .Check(NonEmpty());
  merge.AddOption("--out", options->out, "Folder of the data set").Required().Check(NonEmpty());
  merge.WhenParsed([&command, options] {
    command = [options](const std::string&) { return RunMerge(*options); };
  });
}

}  // namespace

void AddDataset(RecordingCommands& extras) {
  extras.commands["dataset"] = AddDataset;
  extras.commands["merge"] = AddMerge;
}

}  // namespace railcast
