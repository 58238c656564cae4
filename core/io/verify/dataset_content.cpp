#include "core/io/verify/dataset_content.h"

#include <algorithm>
#include <optional>
#include <utility>

#include "core/base/error.h"
#include "core/base/text.h"
#include "core/io/recorded_json.h"
#include "core/io/recording/line_reader.h"
#include "core/io/recording/sequence_check.h"
#include "core/io/run/dataset_files.h"
#include "core/io/run/sensor_folders.h"
#include "core/io/write_file.h"

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

}  // namespace

bool IsDataset(const fs::path& directory) {
  return IsThere(directory / kDatasetFile);
}

DatasetContent ReadDatasetContent(const fs::path& directory) {
  const fs::path file = directory / kDatasetFile;
  return ReadRecordedJson<StrictJson>(
      ReadFileWhole(file), ShownPath(file), [&](const StrictJson& json) {
        DatasetContent content;
        content.num_scenarios = json.at("num_scenarios");
        content.recipe_hash = json.at("recipe_xxh3");
        if (!json.contains("shard")) return content;
        const std::string text = json.at("shard");
        const std::optional<Shard> shard = ParseShard(text);
        if (!shard) {
          throw InputError(ShownPath(file) + ": is damaged: /shard (got " + ShownText(text) + ")");
        }
        content.shard = *shard;
        return content;
      });
}

std::vector<fs::path> FinishedSequences(const fs::path& directory, const DatasetContent& content) {
  // The manifest is written last.
  const std::size_t num_done = NumScenariosDone(directory);
  const bool is_closed = IsThere(directory / kDatasetManifestFile);
  if (num_done < content.num_own() || !is_closed) {
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
    if (of_sensors.empty()) of_sensors.push_back(scenario);
    for (fs::path& sequence : of_sensors) {
      CheckIsFinished(sequence);
      sequences.push_back(std::move(sequence));
    }
  }
  return sequences;
}

}  // namespace railcast
