#include "analysis/study/finished_study.h"

#include <string>

#include "analysis/study/kept_files.h"
#include "analysis/study/study_directory.h"
#include "core/base/error.h"
#include "core/base/input_file.h"
#include "core/base/text.h"
#include "core/io/run/sequence_files.h"
#include "core/io/strict_json.h"
#include "core/program/version.h"

namespace railcast {
namespace {

namespace fs = std::filesystem;

void CheckIsWhole(const fs::path& directory, const Json& identity) {
  const std::string version = identity.value("version", std::string());
  if (version != ProgramVersion()) {
    throw InputError(ShownPath(directory / kStudyFile) + ": /version: must be " + ProgramVersion() +
                     ", that of this program: make the study again, or use the program that made "
                     "it (got " +
                     Json(version).dump() + ")");
  }
  if (identity.contains("shard")) {
    throw InputError(
        ShownPath(directory / kStudyFile) +
        ": /shard: must be absent: railcast-analyze study --shards joins shards (got " +
        identity["shard"].dump() + ")");
  }
}

}  // namespace

FinishedStudy ReadFinishedStudy(const fs::path& directory) {
  FinishedStudy study;
  study.directory = directory;
  study.result.identity = ReadStudyJson(directory);
  const std::string place = ShownPath(directory / kStudyFile);
  const auto num_approaches = ReadJson(place, [&] {
    CheckIsWhole(directory, study.result.identity);
    return study.result.identity.at("num_scenarios").get<std::uint32_t>();
  });
  study.result.num_approaches = num_approaches;
  study.result.approaches = ReadApproaches(directory);
  const std::size_t num_done = study.result.approaches.size();
  // The manifest is written last.
  const bool has_manifest = fs::exists(directory / kManifestFile);
  if (num_done < num_approaches || !has_manifest) {
    throw InputError(ShownPath(directory) + ": must be a finished study (got " +
                     std::to_string(num_done) + " of " + std::to_string(num_approaches) +
                     " approaches" + (has_manifest ? "" : " and no manifest.json") +
                     "); the command that began it, railcast-analyze study, continues it");
  }
  study.sample = CheckKeptFiles(directory);
  study.spec = ReadStudy(directory / kAskedFile);
  study.recipe = ReadRecordedJson<Json>(ReadFileWhole(directory / kAskedRecipeFile),
                                        ShownPath(directory / kAskedRecipeFile),
                                        [](const Json& json) { return json; });
  ReadJson(place, [&] {
    const Json& frames = study.result.identity.at("frames");
    for (std::uint32_t i = 0; i < frames.at("num").get<std::uint32_t>(); ++i) {
      study.frames.push_back(frames.at("first").get<std::uint32_t>() +
                             i * frames.at("stride").get<std::uint32_t>());
    }
  });
  return study;
}

std::vector<ScenarioSpec> ReadSample(const FinishedStudy& study) {
  std::vector<ScenarioSpec> sample;
  for (const fs::path& file : study.sample) sample.push_back(ReadScenario(file));
  return sample;
}

}  // namespace railcast
