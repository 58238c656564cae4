#include "analysis/study/kept_files.h"

#include <algorithm>
#include <set>

#include "core/base/input_file.h"
#include "core/io/run/run_folder.h"
#include "core/io/run/scenario_identity.h"
#include "core/io/run/sequence_files.h"
#include "core/io/write_file.h"

namespace railcast {
namespace {

void KeepScenario(const ScenarioDrawer& drawer,
                  std::uint32_t number,
                  const std::filesystem::path& folder) {
  WriteScenarioFiles(IdentityOf(drawer.Draw(number).scenario), folder, std::string(kScenarioFile));
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
               const ScenarioDrawer& drawer,
               const std::vector<Observation>& worst,
               const std::vector<std::uint32_t>& sample,
               const std::filesystem::path& directory) {
  std::set<std::uint32_t> of_worst;
  for (const Observation& each : worst) of_worst.insert(each.approach->scenario);
  for (const std::uint32_t number : of_worst) {
    KeepScenario(drawer, number, directory / KeptFolder(kWorstFolder, number));
  }
  for (const std::uint32_t number : sample) {
    KeepScenario(drawer, number, directory / KeptFolder(kSampleFolder, number));
  }
  Json asked = Json::parse(ReadFileWhole(study.file));
  asked["recipe"] = std::filesystem::path(kAskedRecipeFile).filename().string();
  MakeFolders((directory / kAskedFile).parent_path());
  WriteFileWhole(directory / kAskedFile, asked.dump(2) + "\n");
  WriteFileWhole(directory / kAskedRecipeFile, ReadFileWhole(study.recipe));
}

}  // namespace railcast
