#include "analysis/verify/dataset_verification.h"

#include <cstdint>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "analysis/verify/dataset_content.h"
#include "analysis/verify/merged_verification.h"
#include "core/base/attempt.h"
#include "core/base/error.h"
#include "core/base/input_file.h"
#include "core/base/text.h"
#include "core/io/content_hash.h"
#include "core/io/dataset_files.h"
#include "core/io/recording/line_reader.h"
#include "core/io/recording/recorded_json.h"
#include "core/io/recording/sequence_check.h"
#include "core/io/recording/sequence_summary.h"
#include "core/io/sensor_folders.h"
#include "core/io/sequence_files.h"
#include "core/io/write_file.h"

namespace railcast {
namespace {

namespace fs = std::filesystem;

/// What a line of scenarios.jsonl says of a sequence.
struct SequenceOfLine {
  std::string folder;
  std::string manifest_hash;
};

/// A line of scenarios.jsonl.
struct ScenarioLine {
  std::uint32_t scenario{};
  std::vector<SequenceOfLine> sequences;
  std::optional<std::string> sensors_hash;  ///< Of several sensors.
};

ScenarioLine ReadScenarioLine(const PlacedLine& line) {
  return ReadRecordedJson<StrictJson>(line.text, line.place, [](const StrictJson& json) {
    ScenarioLine read{json.at("scenario"), {}, {}};
    for (const StrictJson& sequence : json.at("sequences")) {
      read.sequences.push_back({sequence.at("folder"), sequence.at("manifest_xxh3")});
    }
    if (json.contains("sensors_xxh3")) {
      read.sensors_hash = json.at("sensors_xxh3").get<std::string>();
    }
    return read;
  });
}

class DatasetVerifier {
 public:
  DatasetVerifier(const fs::path& directory, const std::function<void(double)>& on_progress)
      : directory_(directory), on_progress_(on_progress), content_(ReadDatasetContent(directory)) {
    known_ = {std::string(kDatasetFile), std::string(kRecipeFile), std::string(kScenariosFile),
              std::string(kDatasetManifestFile)};
  }

  Verification Run() {
    CheckRecipeCopy();
    if (content_.shard.is_whole()) Try([&] { CheckManifest(); });
    Try([&] { CheckScenarios(); });
    Try([&] { FindOthers(); });
    result_.faults = faults_.lines();
    return std::move(result_);
  }

 private:
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
      return Fault(std::string(kDatasetManifestFile), "missing: the data set is unfinished");
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
      const auto scenario = Attempt("", faults_, [&] { return ReadScenarioLine(*line); });
      if (scenario) CheckScenario(*scenario, num_lines, line->place);
    }
    if (num_lines == num_own) return;
    Fault(std::string(kScenariosFile), "must have a line for each of " + NumberText(num_own) +
                                           " scenarios (got " + NumberText(num_lines) + ")");
  }

  void CheckScenario(const ScenarioLine& line, std::uint32_t index, const std::string& place) {
    const std::uint32_t expected = content_.shard.ScenarioAt(index);
    const std::string folder = SequenceFolderOf(expected);
    const auto fail = [&](const std::string& got) {
      faults_.Add({place, "must be the line of scenario " + NumberText(expected) + " in " + folder,
                   ShownText(got)});
    };
    if (line.scenario != expected) return fail(NumberText(line.scenario));
    for (const SequenceOfLine& sequence : line.sequences) {
      const bool is_in_place =
          line.sensors_hash ? sequence.folder.starts_with(folder + "/") : sequence.folder == folder;
      if (!is_in_place) return fail(sequence.folder);
    }
    for (const SequenceOfLine& sequence : line.sequences) CheckSequence(sequence);
    if (!line.sensors_hash) return;
    CheckHash(folder + "/" + std::string(kSensorsFile), *line.sensors_hash, kScenariosFile);
    Try([&] {
      const auto merged = MergedFolderIn(directory_ / folder);
      if (!merged) return;
      sequences_.insert(merged->folder.lexically_relative(directory_).generic_string());
      Add(VerifyMerged(*merged, [](double) {}), 0);
    });
  }

  void CheckSequence(const SequenceOfLine& sequence) {
    sequences_.insert(sequence.folder);
    const std::string manifest = sequence.folder + "/" + std::string(kManifestFile);
    if (IsThere(directory_ / manifest)) CheckHash(manifest, sequence.manifest_hash, kScenariosFile);
    Try([&] {
      const Verification found = VerifySequence(directory_ / sequence.folder, [](double) {});
      Add(found, found.num_frames);
    });
  }

  void Add(const Verification& found, std::uint64_t num_frames) {
    for (const std::string& fault : found.faults) faults_.AddLine(fault);
    result_.num_frames += num_frames;
    result_.num_files += found.num_files;
    result_.num_bytes += found.num_bytes;
  }

  // Files of sequences have been looked at with these.
  void FindOthers() {
    std::error_code error;
    fs::recursive_directory_iterator entry(directory_, error);
    for (const fs::recursive_directory_iterator end; !error && entry != end;
         entry.increment(error)) {
      const std::string name = entry->path().lexically_relative(directory_).generic_string();
      if (entry->symlink_status(error).type() == fs::file_type::directory) {
        if (sequences_.contains(name)) entry.disable_recursion_pending();
        continue;
      }
      if (!known_.contains(name)) Fault(name, "belongs to no scenario of the data set");
    }
    if (error) throw FileError(directory_, error.value());
  }

  const fs::path& directory_;
  const std::function<void(double)>& on_progress_;
  DatasetContent content_;
  std::set<std::string, std::less<>> known_;
  std::set<std::string, std::less<>> sequences_;
  ErrorList faults_;
  Verification result_;
};

}  // namespace

Verification VerifyDataset(const fs::path& directory,
                           const std::function<void(double)>& on_progress) {
  return DatasetVerifier(directory, on_progress).Run();
}

}  // namespace railcast
