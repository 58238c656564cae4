#include "core/io/verify/dataset_verification.h"

#include <cstdint>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "core/base/attempt.h"
#include "core/base/error.h"
#include "core/base/input_file.h"
#include "core/base/text.h"
#include "core/io/content_hash.h"
#include "core/io/recorded_json.h"
#include "core/io/recording/line_reader.h"
#include "core/io/recording/sequence_check.h"
#include "core/io/recording/sequence_summary.h"
#include "core/io/run/dataset_files.h"
#include "core/io/run/sensor_folders.h"
#include "core/io/run/sequence_files.h"
#include "core/io/verify/dataset_content.h"
#include "core/io/verify/scenario_verification.h"
#include "core/io/write_file.h"

namespace railcast {
namespace {

namespace fs = std::filesystem;

class DatasetVerifier {
 public:
  DatasetVerifier(const fs::path& directory, const std::function<void(double)>& on_progress)
      : directory_(directory), on_progress_(on_progress), content_(ReadDatasetContent(directory)) {
    known_ = {std::string(kDatasetFile), std::string(kRecipeFile), std::string(kScenariosFile),
              std::string(kDatasetManifestFile)};
  }

  Verification Run() {
    CheckOwnFiles();
    Try([&] { CheckScenarios(); });
    Try([&] { FindOthers(); });
    return Take();
  }

  Verification RunOnOwnFiles() {
    CheckOwnFiles();
    return Take();
  }

 private:
  void CheckOwnFiles() {
    CheckRecipeCopy();
    Try([&] { CheckManifest(); });
  }
  Verification Take() {
    result_.faults = faults_.lines();
    return std::move(result_);
  }

  template <typename Work>
  void Try(const Work& work) {
    static_cast<void>(Attempt("", faults_, [&] { return work(), true; }));
  }
  void Fault(const std::string& name, const std::string& rule) {
    faults_.Add({ShownPath(directory_ / name), rule, ""});
  }

  // Reads a file and compares its hash.
  void CheckHash(const std::string& name, const std::string& hash, std::string_view said_in) {
    known_.insert(name);
    Try([&] {
      const FileHash got = HashFile(directory_ / name);
      ++result_.num_files;
      result_.num_bytes += got.num_bytes;
      if (got.hash == hash) return;
      Fault(name, "must have the hash " + ShownText(hash) + ", as " + std::string(said_in) +
                      " says (got " + got.hash + ")");
    });
  }

  void CheckRecipeCopy() {
    CheckHash(std::string(kRecipeFile), content_.recipe_hash, kDatasetFile);
  }

  void CheckManifest() {
    const fs::path file = directory_ / kDatasetManifestFile;
    if (!IsThere(file)) {
      return Fault(std::string(kDatasetManifestFile), content_.shard.is_whole()
                                                          ? "missing: the data set is unfinished"
                                                          : "missing: the shard is unfinished");
    }
    const std::string text = ReadFileWhole(file);
    Try([&] { CheckManifestHash(text, ShownPath(file)); });
    ReadRecordedJson<StrictJson>(text, ShownPath(file), [&](const StrictJson& json) {
      for (const auto& [name, hash] : json.at("files_xxh3").items()) {
        CheckHash(name, hash, kDatasetManifestFile);
      }
      return true;
    });
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

  void Add(const Verification& found) {
    for (const std::string& fault : found.faults) faults_.AddLine(fault);
    result_.num_frames += found.num_frames;
    result_.num_files += found.num_files;
    result_.num_bytes += found.num_bytes;
  }

  // Files of scenarios have been looked at with these.
  void FindOthers() {
    std::error_code error;
    fs::recursive_directory_iterator entry(directory_, error);
    for (const fs::recursive_directory_iterator end; !error && entry != end;
         entry.increment(error)) {
      const std::string name = entry->path().lexically_relative(directory_).generic_string();
      if (entry->symlink_status(error).type() == fs::file_type::directory) {
        if (scenarios_.contains(name)) entry.disable_recursion_pending();
        continue;
      }
      if (!known_.contains(name)) Fault(name, "belongs to no scenario of the data set");
    }
    if (error) throw FileError(directory_, error.value());
  }

  const fs::path& directory_;
  const std::function<void(double)> on_progress_;
  DatasetContent content_;
  std::set<std::string, std::less<>> known_;
  std::set<std::string, std::less<>> scenarios_;  ///< Their folders.
  ErrorList faults_;
  Verification result_;
};

}  // namespace

Verification VerifyDataset(const fs::path& directory,
                           const std::function<void(double)>& on_progress) {
  return DatasetVerifier(directory, on_progress).Run();
}

Verification VerifyDatasetFiles(const fs::path& directory) {
  return DatasetVerifier(directory, [](double) {}).RunOnOwnFiles();
}

}  // namespace railcast
