#include "generator/dataset/dataset_files.h"

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
#include "core/io/content_hash.h"
#include "core/io/recording/sequence_summary.h"
#include "core/io/run/dataset_files.h"
#include "core/io/run/run_folder.h"
#include "core/io/write_file.h"
#include "core/recipe/recipe.h"
#include "core/recipe/scenario_lines.h"
#include "generator/dataset/dataset_report.h"
#include "generator/dataset/index_database.h"
#include "generator/dataset/indexed_scenario.h"

namespace railcast {
namespace {

namespace fs = std::filesystem;

constexpr std::array<std::string_view, 9> kHashedFiles = {
    kDatasetFile, kRecipeFile,    kScenariosFile, kIndexFile,    kIndexDatabaseFile,
    kReportFile,  kSplitFiles[0], kSplitFiles[1], kSplitFiles[2]};
/// Those of a shard.
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
                         const Json& report) {
  Json files = Json::object();
  // The program that made the data is named in dataset.json, and SQLite's version in its file.
  std::string data;
  for (const std::string_view name : kHashedFiles) {
    const std::string hash = HashFile(spec.directory / name).hash;
    files[std::string(name)] = hash;
    if (name != kDatasetFile && name != kIndexDatabaseFile && name != kScenariosFile) data += hash;
  }
  data += sequences;
  const Json manifest = {{"version", spec.version},
                         {"num_scenarios", spec.num_scenarios},
                         {"num_frames", report.at("num_frames")},
                         {"points", report.at("points")},
                         {"format", spec.format},
                         {"files_xxh3", std::move(files)},
                         {"data_xxh3", ContentHash(data)}};
  return WithManifestHash(manifest.dump(2) + "\n");
}

}  // namespace

PerPart<std::uint32_t> WriteDatasetFiles(const DatasetSpec& spec) {
  const fs::path& directory = spec.directory;
  fs::create_directories((directory / kSplitFiles[0]).parent_path());
  DatasetReport report;
  IndexDatabase database(directory / kIndexDatabaseFile);
  NewFile index(directory / kIndexFile);
  std::vector<NewFile> splits;
  for (const std::string_view name : kSplitFiles) splits.emplace_back(directory / name);
  // Of a scenario, nothing else stays in memory.
  std::string hashes;
  PerPart<std::uint32_t> parts{};
  ScenarioLines lines(directory / kScenariosFile, spec.shard);
  for (std::uint32_t i = 0; i < spec.num_scenarios; ++i) {
    const IndexedScenario scenario = ReadIndexedScenario(directory, lines.Need().record);
    const Json& record = scenario.record;
    const auto split = ValueNamed<Split>(record.at("split").get<std::string>()).value();
    ++parts.at(static_cast<std::size_t>(split));
    for (const IndexedSequence& sequence : scenario.sequences) {
      const Json& of_sensor = sequence.record;
      splits.at(static_cast<std::size_t>(split))
          .Append(of_sensor.at("folder").get<std::string>() + "\n");
      hashes += of_sensor.at("data_xxh3").get_ref<const std::string&>();
    }
    if (record.contains("sensors_xxh3")) {
      hashes += record.at("sensors_xxh3").get_ref<const std::string&>();
    }
    index.Append(IndexLines(scenario));
    database.Add(scenario);
    report.Add(scenario);
  }
  index.Finish();
  database.Finish();
  for (NewFile& split : splits) split.Finish();
  const Json written = report.Write();
  WriteFileWhole(directory / kReportFile, written.dump(2) + "\n");
  WriteFileWhole(directory / kDatasetManifestFile, ManifestText(spec, hashes, written));
  return parts;
}

void WriteShardManifest(const DatasetSpec& spec) {
  Json files = Json::object();
  for (const std::string_view name : kHashedFilesOfShard) {
    files[std::string(name)] = HashFile(spec.directory / name).hash;
  }
  const Json manifest = {{"version", spec.version},
                         {"shard", ShardText(spec.shard)},
                         {"num_scenarios", spec.shard.NumOf(spec.num_scenarios)},
                         {"files_xxh3", std::move(files)}};
  WriteFileWhole(spec.directory / kDatasetManifestFile, WithManifestHash(manifest.dump(2) + "\n"));
}

}  // namespace railcast
