#include "core/extras/recipe/dataset_verification.h"

#include <string>

#include "core/base/error.h"
#include "core/base/text.h"
#include "core/extras/recipe/dataset_record.h"
#include "core/io/content_hash.h"
#include "core/io/record/read_record.h"
#include "core/io/recording/line_reader.h"
#include "core/io/recording/sequence_check.h"
#include "core/io/run/dataset_files.h"
#include "core/io/run/sensors_record.h"
#include "core/io/run/sequence_files.h"
#include "core/io/verify/findings.h"

namespace railcast {
namespace {

namespace fs = std::filesystem;

class ScenarioVerifier : private Findings {
 public:
  ScenarioVerifier(const fs::path& dataset, std::uint32_t scenario, const PlacedLine& line)
      : dataset_(dataset), scenario_(scenario), folder_(SequenceFolderOf(scenario)), line_(line) {}

  Verification Run() {
    const std::string hash_fault = LineHashFault(line_.text);
    if (!hash_fault.empty()) faults_.Add({line_.place, hash_fault, ""});
    const auto read = Attempt(
        "", faults_, [&] { return ReadRecordLine<ScenarioRecord>(line_.text, line_.place); });
    if (read) CheckLine(*read);
    return Take();
  }

 private:
  void CheckLine(const ScenarioRecord& line) {
    const auto fail = [&](const std::string& got) {
      faults_.Add({line_.place,
                   "must be the line of scenario " + NumberText(scenario_) + " in " + folder_,
                   ShownText(got)});
    };
    if (line.scenario != scenario_) return fail(NumberText(line.scenario));
    for (const SequenceRecord& sequence : line.sequences) {
      const bool is_below = !line.sensors_hash.empty() || !sequence.files.empty();
      const bool is_in_place =
          is_below ? sequence.folder.starts_with(folder_ + "/") : sequence.folder == folder_;
      if (!is_in_place) return fail(sequence.folder);
    }
    for (const SequenceRecord& sequence : line.sequences) {
      if (!sequence.files.empty()) return CheckFiles(sequence);
      CheckSequence(sequence);
    }
    const fs::path folder = dataset_ / folder_;
    if (line.sensors_hash.empty()) {
      Try([&] { Add(VerifySequence(folder, [](double) {})); });
      return;
    }
    CheckHash(folder / kSensorsFile, line.sensors_hash, line_.place);
    Verification found = VerifySensors(folder, [](double) {});
    found.unchecked.clear();  // The line has a hash of sensors.json.
    Add(found);
  }

  void CheckSequence(const SequenceRecord& line) {
    const std::string manifest = line.folder + "/" + std::string(kManifestFile);
    if (IsThere(dataset_ / manifest) &&
        CheckHash(dataset_ / manifest, line.manifest_hash, line_.place)) {
      Try([&] { CompareManifest(dataset_ / manifest, line); });
    }
  }

  void CheckFiles(const SequenceRecord& line) {
    for (const auto& [name, hash] : line.files) {
      if (fs::path(name).is_absolute() ||
          fs::path(name).lexically_normal().begin()->string() == "..") {
        faults_.Add({line_.place, "must name files of the scenario", ShownText(name)});
        continue;
      }
      known_.insert(folder_ + "/" + name);
      CheckHash(dataset_ / folder_ / name, hash, line_.place);
    }
    result_.num_frames += line.num_frames;
    FindOthers(dataset_, "is not named in " + line_.place, {}, folder_);
  }

  // The line repeats what the manifest says.
  void CompareManifest(const fs::path& file, const SequenceRecord& line) {
    const auto compare = [&](const char* key, const std::string& got, const std::string& expected) {
      if (got == expected) return;
      faults_.Add({line_.place + ": /sequences: " + key,
                   "must be " + ShownText(expected) + ", as in " + ShownPath(file),
                   ShownText(got)});
    };
    const auto manifest = ReadRecord<ManifestRecord>(ReadManifestText(file), ShownPath(file));
    compare("points", NumberText(line.points), NumberText(manifest.counts.points));
    compare("num_frames", NumberText(line.num_frames), NumberText(manifest.num_frames));
    compare("data_xxh3", line.data_hash, manifest.data_hash);
    compare("scenario_xxh3", line.scenario_hash, HashOf(kScenarioFile, manifest.files, file));
  }

  const fs::path& dataset_;
  std::uint32_t scenario_;
  std::string folder_;
  const PlacedLine& line_;
};

}  // namespace

Verification VerifyScenario(const fs::path& dataset,
                            std::uint32_t scenario,
                            const PlacedLine& line) {
  return ScenarioVerifier(dataset, scenario, line).Run();
}

}  // namespace railcast
