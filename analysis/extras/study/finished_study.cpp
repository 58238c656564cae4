#include "analysis/extras/study/finished_study.h"

#include <string>

#include "analysis/extras/study/kept_files.h"
#include "analysis/extras/study/study_directory.h"
#include "core/base/error.h"
#include "core/base/input_file.h"
#include "core/base/text.h"
#include "core/io/record/read_record.h"
#include "core/io/run/sequence_files.h"
#include "core/program/version.h"

namespace railcast {
namespace {

namespace fs = std::filesystem;

void CheckIsWhole(const fs::path& directory, const StudyRecord& identity) {
  const std::string place = ShownPath(directory / kStudyFile);
  if (identity.version != ProgramVersion()) {
    throw InputError(place + ": /version: must be " + ProgramVersion() +
                     ", that of this program: make the study again, or use the program that made "
                     "it (got " +
                     Quoted(identity.version) + ")");
  }
  if (!identity.rare.empty()) {
    throw InputError(place + ": /rare: must be absent: its approaches are not those of the recipe" +
                     " (got " + Quoted(identity.rare) + ")");
  }
  if (identity.shard.empty()) return;
  throw InputError(place +
                   ": /shard: must be absent: railcast-analyze study --shards joins shards "
                   "(got " +
                   Quoted(identity.shard) + ")");
}

}  // namespace

FinishedStudy ReadFinishedStudy(const fs::path& directory) {
  FinishedStudy study;
  study.directory = directory;
  study.result.identity = ReadStudyRecord(directory);
  CheckIsWhole(directory, study.result.identity);
  const std::uint32_t num_approaches = study.result.identity.num_scenarios;
  study.result.num_approaches = num_approaches;
  // The manifest is written last.
  const bool has_manifest = fs::exists(directory / kManifestFile);
  if (has_manifest) study.sample = CheckKeptFiles(directory);
  study.result.approaches = ReadApproaches(directory);
  const std::size_t num_done = study.result.approaches.size();
  if (num_done < num_approaches || !has_manifest) {
    throw InputError(ShownPath(directory) + ": must be a finished study (got " +
                     std::to_string(num_done) + " of " + std::to_string(num_approaches) +
                     " approaches" + (has_manifest ? "" : " and no manifest.json") +
                     "); the command that began it, railcast-analyze study, continues it");
  }
  study.spec = ReadStudy(directory / kAskedFile);
  study.recipe = ReadRecordedJson(ReadFileWhole(directory / kAskedRecipeFile),
                                  ShownPath(directory / kAskedRecipeFile));
  const StudyFramesRecord& frames = study.result.identity.frames;
  for (std::uint32_t i = 0; i < frames.num; ++i) {
    study.frames.push_back(frames.first + i * frames.stride);
  }
  return study;
}

std::vector<ScenarioSpec> ReadSample(const FinishedStudy& study) {
  std::vector<ScenarioSpec> sample;
  for (const fs::path& file : study.sample) sample.push_back(ReadScenario(file));
  return sample;
}

}  // namespace railcast
