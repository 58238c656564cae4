#include "core/extras/recipe/dataset_verification.h"

#include <algorithm>
#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "core/base/error.h"
#include "core/base/input_file.h"
#include "core/base/text.h"
#include "core/extras/recipe/dataset_record.h"
#include "core/io/record/read_record.h"
#include "core/io/recording/line_reader.h"
#include "core/io/recording/recording_extras.h"
#include "core/io/recording/sequence_check.h"
#include "core/io/run/dataset_files.h"
#include "core/io/run/folder_kind.h"
#include "core/io/run/run_record.h"
#include "core/io/run/sensors_record.h"
#include "core/io/run/sequence_files.h"
#include "core/io/verify/findings.h"

namespace railcast {
namespace {

namespace fs = std::filesystem;

// Lines of scenarios.jsonl, which is there from the first scenario on.
std::size_t NumScenariosDone(const fs::path& directory) {
  const fs::path file = directory / kScenariosFile;
  return IsThere(file) ? CountLines(file) : 0;
}

void CheckIsFinished(const fs::path& sequence) {
  if (IsThere(sequence / kManifestFile)) return;
  throw InputError(ShownPath(sequence) +
                   ": must be a finished sequence, as all of a data set are (got no "
                   "manifest.json); railcast-analyze verify lists all that is missing");
}

class DatasetVerifier : private Findings {
 public:
  DatasetVerifier(const fs::path& directory, const std::function<void(double)>& on_progress)
      : directory_(directory), on_progress_(on_progress), content_(ReadDatasetContent(directory)) {
    known_ = {std::string(kDatasetFile), std::string(kRecipeFile), std::string(kScenariosFile),
              std::string(kDatasetManifestFile), std::string(kIndexDatabaseFile)};
  }

  Verification Run() {
    CheckOwnFiles();
    Try([&] { CheckScenarios(); });
    // Files of scenarios have been looked at with these.
    FindOthers(directory_, "belongs to no scenario of the data set", scenarios_);
    return Take();
  }

  Verification RunOnOwnFiles() {
    CheckOwnFiles();
    return Take();
  }

 private:
  void CheckOwnFiles() {
    CheckHashes(directory_, std::map{std::pair(std::string(kRecipeFile), content_.recipe_hash)},
                kDatasetFile);
    Try([&] { CheckManifest(); });
  }
  void Fault(const std::string& name, const std::string& rule) {
    faults_.Add({ShownPath(directory_ / name), rule, ""});
  }

  void CheckManifest() {
    const fs::path file = directory_ / kDatasetManifestFile;
    if (!IsThere(file)) {
      return Fault(std::string(kDatasetManifestFile), content_.shard.is_whole()
                                                          ? "missing: the data set is unfinished"
                                                          : "missing: the shard is unfinished");
    }
    CheckHashes(directory_,
                ReadRecord<DatasetManifestRecord>(ReadManifestText(file), ShownPath(file)).files,
                kDatasetManifestFile);
  }

  void CheckScenarios() {
    LineReader lines(directory_ / kScenariosFile);
    const std::uint32_t num_own = content_.shard.NumOf(content_.num_scenarios);
    std::uint32_t num_lines = 0;
    for (; auto line = lines.Next(); ++num_lines) {
      on_progress_(static_cast<double>(num_lines) / static_cast<double>(num_own));
      const std::uint32_t scenario = content_.shard.ScenarioAt(num_lines);
      if (num_lines < num_own) scenarios_.insert(SequenceFolderOf(scenario));
      Add(VerifyScenario(directory_, scenario, *line));
    }
    if (num_lines == num_own) return;
    Fault(std::string(kScenariosFile), "must have a line for each of " + NumberText(num_own) +
                                           " scenarios (got " + NumberText(num_lines) + ")");
  }

  const fs::path& directory_;
  const std::function<void(double)> on_progress_;
  DatasetContent content_;
  NameSet scenarios_;  ///< Their folders.
};

}  // namespace

bool IsDataset(const fs::path& directory) {
  return IsThere(directory / kDatasetFile);
}

DatasetContent ReadDatasetContent(const fs::path& directory) {
  CheckFolderKind(directory, kDatasetFile);
  const fs::path file = directory / kDatasetFile;
  const auto record = ReadRecord<DatasetRecord>(ReadFileWhole(file), ShownPath(file));
  return {.num_scenarios = record.num_scenarios,
          .recipe_hash = record.recipe_hash,
          .shard = ParseShard(record.shard).value_or(Shard{})};
}

std::vector<fs::path> FinishedSequences(const fs::path& directory, const DatasetContent& content) {
  // The manifest is written last.
  const std::size_t num_done = NumScenariosDone(directory);
  const bool is_closed = IsThere(directory / kDatasetManifestFile);
  if (is_closed && num_done < content.num_own()) {
    throw InputError(ShownPath(directory / kScenariosFile) + ": must have a line for each of " +
                     NumberText(content.num_own()) + " scenarios, since the data set has a " +
                     std::string(kDatasetManifestFile) + " (got " + NumberText(num_done) + ")");
  }
  if (!is_closed) {
    const std::string got =
        num_done < content.num_own()
            ? NumberText(num_done) + " of " + NumberText(content.num_own()) + " scenarios"
            : "no " + std::string(kDatasetManifestFile);
    throw InputError(ShownPath(directory) + ": must be a finished data set (got " + got +
                     "); the command that began it, railcast-generate dataset, continues it");
  }
  std::vector<fs::path> sequences;
  for (std::uint32_t i = 0; i < content.num_own(); ++i) {
    const fs::path scenario = directory / SequenceFolderOf(content.shard.ScenarioAt(i));
    std::vector<fs::path> of_sensors = SensorFoldersIn(scenario);
    if (of_sensors.empty()) {
      const fs::path recording = scenario / kRecordingFolder;
      of_sensors.push_back(fs::is_directory(recording) ? recording : scenario);
    }
    for (fs::path& sequence : of_sensors) {
      // Recordings of other programs do not say of themselves that they are finished.
      if (sequence.filename() != kRecordingFolder || IsThere(sequence / kRunFile)) {
        CheckIsFinished(sequence);
      }
      sequences.push_back(std::move(sequence));
    }
  }
  return sequences;
}

Verification VerifyDataset(const fs::path& directory,
                           const std::function<void(double)>& on_progress) {
  return DatasetVerifier(directory, on_progress).Run();
}

Verification VerifyDatasetFiles(const fs::path& directory) {
  return DatasetVerifier(directory, [](double) {}).RunOnOwnFiles();
}

void AddRecipe(RecordingExtras& extras) {
  extras.verify["recipe"] = VerifyDataset;
}

}  // namespace railcast
