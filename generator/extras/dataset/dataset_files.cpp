#include "generator/extras/dataset/dataset_directory.h"

#include <algorithm>
#include <array>
#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>
#include <system_error>
#include <utility>
#include <vector>

#include "core/base/error.h"
#include "core/base/input_file.h"
#include "core/extras/recipe/dataset_record.h"
#include "core/extras/recipe/dataset_report_record.h"
#include "core/extras/recipe/recipe.h"
#include "core/extras/recipe/scenario_lines.h"
#include "core/io/content_hash.h"
#include "core/io/record/record_text.h"
#include "core/io/run/dataset_files.h"
#include "core/io/run/run_folder.h"
#include "core/io/write_file.h"
#include "generator/extras/dataset/dataset_report.h"
#include "generator/extras/dataset/indexed_scenario.h"

namespace railcast {
namespace {

namespace fs = std::filesystem;

constexpr std::array<std::string_view, 8> kHashedFiles = {
    kDatasetFile, kRecipeFile,    kScenariosFile, kIndexFile,
    kReportFile,  kSplitFiles[0], kSplitFiles[1], kSplitFiles[2]};
/// The files of a shard that have hashes.
constexpr std::array<std::string_view, 3> kHashedFilesOfShard = {kDatasetFile, kRecipeFile,
                                                                 kScenariosFile};

/// A file that grows line by line under another name until it is whole.
class NewFile {
 public:
  explicit NewFile(fs::path file)
      : file_(std::move(file)),
        unfinished_(file_.string() + std::string(kUnfinishedSuffix)),
        lines_(unfinished_, 0) {}

  void Append(const std::string& lines) { lines_.Append(lines); }
  void Finish() {
    lines_.Sync();
    std::error_code error;
    fs::rename(unfinished_, file_, error);
    if (error) throw FileError(file_, error.value());
  }

 private:
  fs::path file_;
  fs::path unfinished_;
  LineFile lines_;
};

/// @param sequences The hashes of all sequences' data, one after the other.
std::string ManifestText(const DatasetSpec& spec,
                         const std::string& sequences,
                         const DatasetReportRecord& report) {
  DatasetManifestRecord manifest{.version = spec.record.version,
                                 .num_scenarios = spec.record.num_scenarios,
                                 .num_frames = report.num_frames,
                                 .points = report.counts.points,
                                 .format = spec.record.format};
  // The program that made the data is named in dataset.json.
  std::string data;
  for (const std::string_view name : kHashedFiles) {
    const std::string hash = HashFile(spec.directory / name).hash;
    manifest.files.emplace_back(name, hash);
    if (name != kDatasetFile && name != kScenariosFile) data += hash;
  }
  manifest.data_hash = ContentHash(data + sequences);
  return WithManifestHash(RecordFile(manifest));
}

}  // namespace

PerPart<std::uint32_t> WriteDatasetFiles(const DatasetSpec& spec) {
  const fs::path& directory = spec.directory;
  fs::create_directories((directory / kSplitFiles[0]).parent_path());
  fs::remove(directory / kIndexDatabaseFile);
  DatasetReport report;
  NewFile index(directory / kIndexFile);
  std::vector<NewFile> splits;
  for (const std::string_view name : kSplitFiles) splits.emplace_back(directory / name);
  // Nothing else of a scenario stays in memory.
  std::string hashes;
  PerPart<std::uint32_t> parts{};
  ScenarioLines lines(directory / kScenariosFile, spec.shard);
  for (std::uint32_t i = 0; i < spec.record.num_scenarios; ++i) {
    const IndexedScenario scenario = ReadIndexedScenario(directory, lines.Need());
    const ScenarioRecord& record = scenario.record;
    const auto split = ValueNamed<Split>(record.split).value();
    ++parts.at(static_cast<std::size_t>(split));
    for (const SequenceRecord& sequence : record.sequences) {
      splits.at(static_cast<std::size_t>(split)).Append(sequence.folder + "\n");
      hashes += sequence.data_hash;
    }
    hashes += record.sensors_hash;
    index.Append(IndexLines(scenario));
    report.Add(scenario);
  }
  index.Finish();
  for (NewFile& split : splits) split.Finish();
  const DatasetReportRecord written = report.Record();
  WriteFileWhole(directory / kReportFile, RecordFile(written));
  WriteFileWhole(directory / kDatasetManifestFile, ManifestText(spec, hashes, written));
  return parts;
}

void WriteShardManifest(const DatasetSpec& spec) {
  DatasetManifestRecord manifest{.version = spec.record.version,
                                 .shard = ShardText(spec.shard),
                                 .num_scenarios = spec.shard.NumOf(spec.record.num_scenarios)};
  for (const std::string_view name : kHashedFilesOfShard) {
    manifest.files.emplace_back(name, HashFile(spec.directory / name).hash);
  }
  WriteFileWhole(spec.directory / kDatasetManifestFile, WithManifestHash(RecordFile(manifest)));
}

}  // namespace railcast
