#include "generator/dataset/dataset_files.h"

#include <algorithm>
#include <array>
#include <filesystem>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "core/base/error.h"
#include "core/base/input_file.h"
#include "core/io/content_hash.h"
#include "core/io/dataset_files.h"
#include "core/io/recording/sequence_summary.h"
#include "core/io/write_file.h"
#include "generator/dataset/dataset_report.h"
#include "generator/dataset/index_database.h"
#include "generator/dataset/indexed_scenario.h"
#include "generator/dataset/recipe.h"

namespace railcast {
namespace {

namespace fs = std::filesystem;

constexpr std::array<std::string_view, 9> kHashedFiles = {
    kDatasetFile, kRecipeFile,    kScenariosFile, kIndexFile,    kIndexDatabaseFile,
    kReportFile,  kSplitFiles[0], kSplitFiles[1], kSplitFiles[2]};

std::string ManifestText(const DatasetSpec& spec,
                         const std::vector<std::string>& lines,
                         const Json& report) {
  Json files = Json::object();
  // The program that made the data is named in dataset.json, and SQLite's version in its file.
  std::string data;
  for (const std::string_view name : kHashedFiles) {
    const std::string hash = ContentHash(ReadFileWhole(spec.directory / name));
    files[std::string(name)] = hash;
    if (name != kDatasetFile && name != kIndexDatabaseFile && name != kScenariosFile) data += hash;
  }
  for (const std::string& line : lines) {
    data += Json::parse(line).at("data_xxh3").get_ref<const std::string&>();
  }
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

void WriteDatasetFiles(const DatasetSpec& spec) {
  const fs::path& directory = spec.directory;
  std::uint64_t size = 0;
  const std::vector<std::string> lines = ScenarioLines(directory, spec.shard, size);
  Check(lines.size() == spec.num_scenarios, "all scenarios are done");
  fs::create_directories((directory / kSplitFiles[0]).parent_path());
  DatasetReport report;
  IndexDatabase database(directory / kIndexDatabaseFile);
  const fs::path index = directory / kIndexFile;
  const fs::path unfinished = index.string() + std::string(kUnfinishedSuffix);
  std::array<std::string, kSplitFiles.size()> splits;
  {
    LineFile index_lines(unfinished, 0);
    for (const std::string& line : lines) {
      const IndexedScenario scenario = ReadIndexedScenario(directory, line);
      const Json& record = scenario.record;
      const auto split = ValueNamed<Split>(record.at("split").get<std::string>()).value();
      splits.at(static_cast<std::size_t>(split)) += record.at("folder").get<std::string>() + "\n";
      index_lines.Append(IndexLines(scenario));
      database.Add(scenario);
      report.Add(scenario);
    }
    index_lines.Sync();
  }
  std::error_code error;
  fs::rename(unfinished, index, error);
  if (error) throw FileError(index, error.value());
  database.Finish();
  const Json written = report.Write();
  for (std::size_t i = 0; i < splits.size(); ++i) {
    WriteFileWhole(directory / kSplitFiles[i], splits[i]);
  }
  WriteFileWhole(directory / kReportFile, written.dump(2) + "\n");
  WriteFileWhole(directory / kDatasetManifestFile, ManifestText(spec, lines, written));
}

}  // namespace railcast
