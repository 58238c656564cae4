#include <filesystem>
#include <limits>
#include <utility>

#include "core/base/error.h"
#include "core/base/text.h"
#include "core/extras/recipe/dataset_record.h"
#include "core/extras/recipe/scenario_lines.h"
#include "core/io/content_hash.h"
#include "core/io/record/read_record.h"
#include "core/io/record/record_text.h"
#include "core/io/recording/sequence_check.h"
#include "core/io/run/dataset_files.h"
#include "core/io/run/run_folder.h"
#include "core/io/run/run_record.h"
#include "core/io/run/sensors_record.h"
#include "core/io/write_file.h"
#include "generator/extras/convert/convert.h"
#include "generator/extras/dataset/dataset_directory.h"

namespace railcast {
namespace {

namespace fs = std::filesystem;

/// The data set that the conversion writes.
/// @throws InputError if the recorded one is unfinished, or not of sequences alone.
DatasetSpec SpecOfConvertedSet(const ConvertChoices& choices) {
  const fs::path& source = choices.recording;
  const auto fail = [&](const std::string& rule) {
    throw InputError(ShownPath(source) + ": must be " + rule);
  };
  if (choices.last_frame) throw InputError("--frames: must be left out for a data set");
  if (!fs::exists(source / kDatasetManifestFile)) fail("a complete data set");
  const auto manifest = ReadRecord<DatasetManifestRecord>(
      ReadManifestText(source / kDatasetManifestFile), ShownPath(source / kDatasetManifestFile));
  for (const auto& [name, hash] : manifest.files) {
    (void)ReadHashedFile(source, {name, hash, {}}, kDatasetManifestFile);
  }
  DatasetSpec spec{.directory = choices.directory,
                   .recipe = ReadFileWhole(source / kRecipeFile),
                   .record = ReadRecord<DatasetRecord>(ReadFileWhole(source / kDatasetFile),
                                                       ShownPath(source / kDatasetFile)),
                   .shard = {}};
  if (!spec.record.shard.empty()) fail("a whole data set (got shard " + spec.record.shard + ")");
  if (spec.record.is_merged) fail("a data set without merged clouds (got --merged)");
  const PlacedLine line = ScenarioLines(source / kScenariosFile, {}).Need();
  const auto first = ReadRecordLine<ScenarioRecord>(line.text, line.place);
  spec.record.is_converted = !first.sequences.empty() && !first.sequences[0].files.empty();
  spec.record.format = choices.format;
  if (ParseFrameFormat(choices.format).files.empty()) {
    throw InputError(
        "--format: must have files for each frame, which the index of a data set "
        "names; its sequences become bags one by one (got " +
        choices.format + ")");
  }
  if (ParseFrameFormat(choices.format).dataset || choices.fields != "all") {
    spec.record.fields = choices.fields;
  }
  return spec;
}

/// Says of a converted sequence what is in its files.
void TakeConverted(const fs::path& sequence, SequenceRecord& record) {
  const fs::path file = sequence / kManifestFile;
  const auto manifest = ReadRecord<ManifestRecord>(ReadManifestText(file), ShownPath(file));
  record.points = manifest.counts.points;
  record.data_hash = manifest.data_hash;
  record.manifest_hash = HashFile(file).hash;
  record.scenario_hash = HashOf(kScenarioFile, manifest.files, file);
  record.bag.reset();
  record.files.clear();
}

class DatasetConversion {
 public:
  DatasetConversion(const ConvertChoices& choices, const RunHooks& hooks)
      : choices_(choices), hooks_(hooks), directory_(SpecOfConvertedSet(choices)) {}

  ConvertResult Run() {
    result_.num = directory_.spec().record.num_scenarios;
    const bool is_checked = directory_.Check([&](double) { return !hooks_.is_stopped(); });
    result_.was_complete = directory_.is_complete();
    result_.changed = directory_.changed();
    result_.num_resumed = directory_.num_done() + directory_.num_kept();
    hooks_.on_progress(directory_.num_done(), result_.num);
    ScenarioLines lines(choices_.recording / kScenariosFile, {});
    const bool has_all = is_checked && Convert(lines);
    result_.num_done = directory_.num_done();
    if (has_all && !result_.was_complete) {
      directory_.Sync();
      (void)WriteDatasetFiles(directory_.spec());
    }
    result_.is_complete = has_all;
    return result_;
  }

 private:
  /// Returns false if it was stopped.
  bool Convert(ScenarioLines& lines) {
    // The sequences of scenarios that are there say again what is lost.
    for (std::uint32_t i = 0; i < result_.num; ++i) {
      const PlacedLine line = lines.Need();
      auto record = ReadRecordLine<ScenarioRecord>(line.text, line.place);
      if (!ConvertScenario(record)) return false;
      if (i < directory_.num_done()) continue;
      const std::string* const kept = directory_.Kept(i);
      directory_.Append(kept != nullptr ? *kept : RecordText(record));
      hooks_.on_progress(directory_.num_done(), result_.num);
    }
    return true;
  }

  bool ConvertScenario(ScenarioRecord& record) {
    for (SequenceRecord& sequence : record.sequences) {
      ConvertChoices choices = choices_;
      choices.recording /= sequence.folder;
      // The recording into which an insertion put things stands in a folder of its own.
      const bool is_insertion = !sequence.files.empty();
      if (is_insertion) {
        sequence.folder = SequenceFolderOf(record.scenario);
        choices.recording = choices_.recording / sequence.folder;
      }
      choices.directory /= sequence.folder;
      if (!BecomesSequence(choices)) {
        throw InputError(ShownPath(choices.recording) +
                         (is_insertion
                              ? ": must be an insertion into a sequence in another format than "
                                "kitti: other recordings do not hold what a data set lists of "
                                "frames"
                              : ": must be a sequence in another format than kitti"));
      }
      CheckFiles(record.scenario, sequence);
      MakeFolders(choices.directory);
      const ConvertResult made = ConvertSequence(choices, {[](auto, auto) {}, hooks_.is_stopped});
      if (!made.is_complete) return false;
      for (const auto& [what, number] : made.lost) AddLoss(what, number, result_.lost);
      TakeConverted(choices.directory, sequence);
    }
    if (!record.sensors_hash.empty()) CopySensors(record);
    return true;
  }

  /// Checks that the files of an insertion are as they were written.
  void CheckFiles(std::uint32_t scenario, const SequenceRecord& sequence) const {
    for (const auto& [name, hash] : sequence.files) {
      const fs::path file = fs::path(SequenceFolderOf(scenario)) / name;
      (void)ReadHashedFile(choices_.recording, {file.string(), hash, {}}, kScenariosFile);
    }
  }

  /// Where the folders of several sensors are is the same; their manifests are others.
  void CopySensors(ScenarioRecord& record) const {
    const fs::path name = fs::path(SequenceFolderOf(record.scenario)) / kSensorsFile;
    SensorsRecord sensors =
        ReadSensorsText(ReadHashedFile(choices_.recording, {name.string(), record.sensors_hash, {}},
                                       kScenariosFile),
                        ShownPath(choices_.recording / name));
    for (SensorRecord& sensor : sensors.sensors) {
      const auto sequence =
          std::ranges::find(record.sequences, sensor.name, &SequenceRecord::sensor);
      if (sequence != record.sequences.end()) sensor.manifest_hash = sequence->manifest_hash;
    }
    const std::string text = SensorsText(sensors);
    WriteFileWhole(choices_.directory / name, text);
    record.sensors_hash = ContentHash(text);
  }

  const ConvertChoices& choices_;
  const RunHooks& hooks_;
  DatasetDirectory directory_;
  ConvertResult result_;
};

}  // namespace

ConvertResult ConvertDataset(const ConvertChoices& choices, const RunHooks& hooks) {
  return DatasetConversion(choices, hooks).Run();
}

}  // namespace railcast
