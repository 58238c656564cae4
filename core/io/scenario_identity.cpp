#include "core/io/scenario_identity.h"

#include <algorithm>
#include <filesystem>
#include <map>
#include <utility>
#include <variant>

#include "core/base/error.h"
#include "core/io/content_hash.h"
#include "core/io/sequence_files.h"
#include "core/io/write_file.h"
#include "railcast/scenario.h"

namespace railcast {
namespace {

// Replaces the paths of a scenario's files by names derived from their content.
class FileNaming {
 public:
  void Rename(std::string& file) {
    auto known = copy_of_.find(file);
    if (known == copy_of_.end()) {
      InputFile input{std::filesystem::path(file).filename().string(), {}, ReadFileWhole(file)};
      input.hash = ContentHash(input.bytes);
      known = copy_of_.emplace(file, input.CopyName()).first;
      // The same file may lie in two folders but is stored once.
      if (std::ranges::find(inputs_, input) == inputs_.end()) inputs_.push_back(std::move(input));
    }
    file = known->second;
  }
  void Rename(LidarSpec& lidar) {
    if (auto* table = std::get_if<FiringTableSpec>(&lidar.scan.pattern)) Rename(table->file);
  }
  void Rename(ScenarioSpec& scenario) {
    Rename(scenario.lidar);
    for (LidarSpec& lidar : scenario.lidars) Rename(lidar);
    if (auto& elevation = scenario.world.terrain.elevation) Rename(elevation->file);
    for (ObjectSpec& object : scenario.world.objects) {
      if (object.file) Rename(*object.file);
    }
  }

  [[nodiscard]] std::vector<InputFile>& inputs() { return inputs_; }

 private:
  std::map<std::string, std::string> copy_of_;  // The name of the copy by the path in the scenario.
  std::vector<InputFile> inputs_;
};

}  // namespace

std::string InputFile::CopyName() const {
  return std::string(kInputsFolder) + "/" + hash + "/" + name;
}

ScenarioIdentity IdentityOf(const ScenarioSpec& scenario) {
  ScenarioSpec anywhere = scenario;
  FileNaming naming;
  naming.Rename(anywhere);
  ScenarioIdentity identity;
  identity.scenario_json = ResolvedScenarioJson(anywhere);
  identity.scenario_hash = ContentHash(identity.scenario_json);
  identity.inputs = std::move(naming.inputs());
  return identity;
}

void CheckSameFiles(const ScenarioSpec& scenario, const ScenarioIdentity& identity) {
  const ScenarioIdentity now = IdentityOf(scenario);
  for (const InputFile& input : now.inputs) {
    if (std::ranges::find(identity.inputs, input) != identity.inputs.end()) continue;
    throw InputError(input.name + ": was changed while the scenario was read; run it again");
  }
}

ScenarioSpec WithFilesByContent(const ScenarioSpec& scenario) {
  ScenarioSpec anywhere = scenario;
  FileNaming().Rename(anywhere);
  return anywhere;
}

}  // namespace railcast
