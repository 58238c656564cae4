#include "analysis/extras/study/kept_files.h"

#include <algorithm>
#include <set>

#include "analysis/extras/study/study_directory.h"
#include "core/base/error.h"
#include "core/base/input_file.h"
#include "core/base/text.h"
#include "core/io/content_hash.h"
#include "core/io/record/read_record.h"
#include "core/io/record/record_text.h"
#include "core/io/run/run_folder.h"
#include "core/io/run/run_record.h"
#include "core/io/run/scenario_identity.h"
#include "core/io/run/sequence_files.h"
#include "core/io/verify/findings.h"
#include "core/io/write_file.h"

namespace railcast {
namespace {

// Returns the names of its files.
std::set<std::string> KeepScenario(const DrawByNumber& draw,
                                   std::uint32_t number,
                                   const std::string& folder,
                                   const std::filesystem::path& directory) {
  const ScenarioIdentity identity = IdentityOf(draw(number).scenario);
  WriteScenarioFiles(identity, directory / folder, std::string(kScenarioFile));
  std::set<std::string> names = {folder + "/" + std::string(kScenarioFile)};
  for (const InputFile& input : identity.inputs) names.insert(folder + "/" + input.CopyName());
  return names;
}

void WriteManifest(const std::set<std::string>& names, const std::filesystem::path& directory) {
  StudyManifestRecord manifest;
  for (const std::string& name : names) {
    manifest.files.emplace_back(name, HashFile(directory / name).hash);
  }
  WriteFileWhole(directory / kManifestFile, WithManifestHash(RecordFile(manifest)));
}

}  // namespace

std::string KeptFolder(std::string_view folder, std::uint32_t scenario) {
  return std::string(folder) + "/" + FrameDigits(scenario);
}

std::vector<std::uint32_t> SampleOf(const std::vector<Observation>& observations) {
  constexpr std::size_t kMostSampled = 16;
  std::set<std::uint32_t> numbers;
  for (const Observation& each : observations) numbers.insert(each.approach->scenario);
  const std::vector<std::uint32_t> all(numbers.begin(), numbers.end());
  const std::size_t num = std::min(all.size(), kMostSampled);
  std::vector<std::uint32_t> sample;
  for (std::size_t i = 0; i < num; ++i) {
    sample.push_back(all[(2 * i + 1) * all.size() / (2 * num)]);
  }
  return sample;
}

void KeepFiles(const StudySpec& study,
               const DrawByNumber& draw,
               const std::vector<Observation>& worst,
               const std::vector<std::uint32_t>& sample,
               const std::filesystem::path& directory) {
  std::set<std::uint32_t> of_worst;
  for (const Observation& each : worst) of_worst.insert(each.approach->scenario);
  std::set<std::string> names;
  for (const std::uint32_t number : of_worst) {
    names.merge(KeepScenario(draw, number, KeptFolder(kWorstFolder, number), directory));
  }
  for (const std::uint32_t number : sample) {
    names.merge(KeepScenario(draw, number, KeptFolder(kSampleFolder, number), directory));
  }
  Json asked = Json::parse(ReadFileWhole(study.file));
  asked["recipe"] = std::filesystem::path(kAskedRecipeFile).filename().string();
  MakeFolders((directory / kAskedFile).parent_path());
  WriteFileWhole(directory / kAskedFile, asked.dump(2) + "\n");
  WriteFileWhole(directory / kAskedRecipeFile, ReadFileWhole(study.recipe));
  for (const std::string_view name : {kAskedFile, kAskedRecipeFile, kStudyFile, kApproachesFile}) {
    names.emplace(name);
  }
  WriteManifest(names, directory);
}

std::vector<std::filesystem::path> CheckKeptFiles(const std::filesystem::path& directory) {
  const std::filesystem::path manifest = directory / kManifestFile;
  ErrorList faults;
  std::vector<std::filesystem::path> sample;
  const auto record =
      ReadRecord<StudyManifestRecord>(ReadManifestText(manifest), ShownPath(manifest));
  for (const auto& [name, hash] : record.files) {
    (void)CompareHash(directory / name, hash, std::string(kManifestFile), faults);
    if (name.starts_with(std::string(kSampleFolder) + "/") && name.ends_with(kScenarioFile)) {
      sample.push_back(directory / name);
    }
  }
  faults.ThrowIfAny();
  return sample;
}

}  // namespace railcast
