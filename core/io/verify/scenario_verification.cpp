#include "core/io/verify/scenario_verification.h"

#include <optional>
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
#include "core/io/recording/sequence_check.h"
#include "core/io/run/dataset_files.h"
#include "core/io/run/line_hash.h"
#include "core/io/run/sensor_folders.h"
#include "core/io/run/sequence_files.h"
#include "core/io/verify/merged_verification.h"
#include "core/io/write_file.h"

namespace railcast {
namespace {

namespace fs = std::filesystem;

/// What a line of scenarios.jsonl says of a sequence.
struct SequenceOfLine {
  std::string folder;
  std::string manifest_hash;
  std::string data_hash;
  std::string scenario_hash;
  std::uint64_t points{};
  std::uint32_t num_frames{};
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
      read.sequences.push_back({sequence.at("folder"), sequence.at("manifest_xxh3"),
                                sequence.at("data_xxh3"), sequence.at("scenario_xxh3"),
                                sequence.at("points"), sequence.at("num_frames")});
    }
    if (json.contains("sensors_xxh3")) {
      read.sensors_hash = json.at("sensors_xxh3").get<std::string>();
    }
    return read;
  });
}

class ScenarioVerifier {
 public:
  ScenarioVerifier(const fs::path& dataset, std::uint32_t scenario, const PlacedLine& line)
      : dataset_(dataset), scenario_(scenario), folder_(SequenceFolderOf(scenario)), line_(line) {}

  Verification Run() {
    const auto read = Attempt("", faults_, [&] { return ReadScenarioLine(line_); });
    if (read) {
      const std::string hash_fault = LineHashFault(line_.text);
      if (!hash_fault.empty()) faults_.Add({line_.place, hash_fault, ""});
      CheckLine(*read);
    }
    result_.faults = faults_.lines();
    return std::move(result_);
  }

 private:
  template <typename Work>
  void Try(const Work& work) {
    static_cast<void>(Attempt("", faults_, [&] { return work(), true; }));
  }

  void CheckLine(const ScenarioLine& line) {
    const auto fail = [&](const std::string& got) {
      faults_.Add({line_.place,
                   "must be the line of scenario " + NumberText(scenario_) + " in " + folder_,
                   ShownText(got)});
    };
    if (line.scenario != scenario_) return fail(NumberText(line.scenario));
    for (const SequenceOfLine& sequence : line.sequences) {
      const bool is_in_place = line.sensors_hash ? sequence.folder.starts_with(folder_ + "/")
                                                 : sequence.folder == folder_;
      if (!is_in_place) return fail(sequence.folder);
    }
    for (const SequenceOfLine& sequence : line.sequences) CheckSequence(sequence);
    if (!line.sensors_hash) return;
    CheckHash(folder_ + "/" + std::string(kSensorsFile), *line.sensors_hash);
    Try([&] {
      const auto merged = MergedFolderIn(dataset_ / folder_);
      if (!merged) return;
      sequences_.insert(merged->folder.lexically_relative(dataset_).generic_string());
      Add(VerifyMerged(*merged, [](double) {}), 0);
    });
    Try([&] { FindOthers(); });
  }

  void CheckSequence(const SequenceOfLine& line) {
    sequences_.insert(line.folder);
    const std::string manifest = line.folder + "/" + std::string(kManifestFile);
    if (IsThere(dataset_ / manifest) && CheckHash(manifest, line.manifest_hash)) {
      Try([&] { CompareManifest(dataset_ / manifest, line); });
    }
    Try([&] {
      const Verification found = VerifySequence(dataset_ / line.folder, [](double) {});
      Add(found, found.num_frames);
    });
  }

  // The line repeats what the manifest says.
  void CompareManifest(const fs::path& file, const SequenceOfLine& line) {
    const auto compare = [&](const char* key, const std::string& got, const std::string& expected) {
      if (got == expected) return;
      faults_.Add({line_.place + ": /sequences: " + key,
                   "must be " + ShownText(expected) + ", as in " + ShownPath(file),
                   ShownText(got)});
    };
    ReadRecordedJson<StrictJson>(ReadFileWhole(file), ShownPath(file), [&](const StrictJson& json) {
      const StrictJson& hashes = json.at("files_xxh3");
      compare("points", NumberText(line.points), json.at("points").dump());
      compare("num_frames", NumberText(line.num_frames), json.at("num_frames").dump());
      compare("data_xxh3", line.data_hash, json.at("data_xxh3").get<std::string>());
      compare("scenario_xxh3", line.scenario_hash,
              hashes.at(std::string(kScenarioFile)).get<std::string>());
      return true;
    });
  }

  // Reads a file and compares its hash. Returns whether it is that one.
  bool CheckHash(const std::string& name, const std::string& hash) {
    bool is_same = false;
    Try([&] {
      const FileHash got = HashFile(dataset_ / name);
      ++result_.num_files;
      result_.num_bytes += got.num_bytes;
      is_same = got.hash == hash;
      if (is_same) return;
      faults_.Add({ShownPath(dataset_ / name),
                   "must have the hash " + ShownText(hash) + ", as " + line_.place + " says",
                   got.hash});
    });
    return is_same;
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
    fs::recursive_directory_iterator entry(dataset_ / folder_, error);
    for (const fs::recursive_directory_iterator end; !error && entry != end;
         entry.increment(error)) {
      const std::string name = entry->path().lexically_relative(dataset_).generic_string();
      if (entry->symlink_status(error).type() == fs::file_type::directory) {
        if (sequences_.contains(name)) entry.disable_recursion_pending();
      } else if (name != folder_ + "/" + std::string(kSensorsFile)) {
        faults_.Add({ShownPath(entry->path()), "belongs to no sequence of the scenario", ""});
      }
    }
    if (error) throw FileError(dataset_ / folder_, error.value());
  }

  const fs::path& dataset_;
  std::uint32_t scenario_;
  std::string folder_;
  const PlacedLine& line_;
  std::set<std::string, std::less<>> sequences_;
  ErrorList faults_;
  Verification result_;
};

}  // namespace

Verification VerifyScenario(const fs::path& dataset,
                            std::uint32_t scenario,
                            const PlacedLine& line) {
  return ScenarioVerifier(dataset, scenario, line).Run();
}

}  // namespace railcast
