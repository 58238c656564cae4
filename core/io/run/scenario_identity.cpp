#include "core/io/run/scenario_identity.h"

#include <algorithm>
#include <filesystem>
#include <map>
#include <utility>
#include <variant>

#include "core/base/error.h"
#include "core/base/shipped_files.h"
#include "core/io/content_hash.h"
#include "core/io/run/run_folder.h"
#include "core/io/run/sequence_files.h"
#include "core/io/run/survey_record.h"
#include "core/io/write_file.h"
#include "core/mesh/mesh_import.h"
#include "railcast/scenario.h"

namespace railcast {
namespace {

// Replaces the paths of a scenario's files by names derived from their content.
class FileNaming {
 public:
  void Rename(std::string& file) {
    auto known = copy_of_.find(file);
    if (known == copy_of_.end()) {
      InputFile input =
          InputOf(std::filesystem::path(file).filename().string(), ReadFileWhole(file));
      known = copy_of_.emplace(file, input.CopyName()).first;
      Add(std::move(input));
    }
    file = known->second;
  }
  /// A mesh and what is read with it: their copies lie beside each other, too.
  void RenameMesh(std::string& file) {
    if (ShippedFile(file)) return;  // It is the program's.
    if (!copy_of_.contains(file)) {
      const std::filesystem::path path = file;
      std::vector<InputFile> inputs = {InputOf(path.filename().string(), ReadFileWhole(file))};
      for (FileBeside& beside : FilesBesideMesh(inputs.front().bytes, path)) {
        inputs.push_back(InputOf(beside.name, std::move(beside.bytes)));
      }
      if (inputs.size() > 1) {
        std::string names_and_hashes;
        for (const InputFile& input : inputs)
          names_and_hashes += input.name + '\n' + input.hash + '\n';
        for (InputFile& input : inputs) input.folder = ContentHash(names_and_hashes);
      }
      copy_of_.emplace(file, inputs.front().CopyName());
      for (InputFile& input : inputs) Add(std::move(input));
    }
    file = copy_of_.at(file);
  }
  void Rename(LidarSpec& lidar) {
    if (auto* table = std::get_if<FiringTableSpec>(&lidar.scan.pattern)) Rename(table->file);
    if (lidar.ouster_metadata) Rename(*lidar.ouster_metadata);
  }
  void Rename(ScenarioSpec& scenario) {
    Rename(scenario.lidar);
    for (LidarSpec& lidar : scenario.lidars) Rename(lidar);
    if (auto& elevation = scenario.world.terrain.elevation) Rename(elevation->file);
    if (auto& survey = scenario.world.survey) {
      CheckSurveyFile(*survey, HashFile(*survey).hash);
      Rename(*survey);
    }
    if (auto& recording = scenario.world.recording; recording && recording->poses_file) {
      Rename(*recording->poses_file);
    }
    for (ObjectSpec& object : scenario.world.objects) {
      if (object.file) RenameMesh(*object.file);
    }
    for (ModelSpec& model : scenario.models) {
      RenameMesh(model.file);
      if (model.rail_vehicle) RenameMesh(model.rail_vehicle->bogie);
    }
  }

  [[nodiscard]] std::vector<InputFile>& inputs() { return inputs_; }

 private:
  static InputFile InputOf(std::string name, std::string bytes) {
    InputFile input{std::move(name), ContentHash(bytes), {}};
    input.bytes = std::move(bytes);
    return input;
  }
  /// The same file may lie in two folders but is stored once.
  void Add(InputFile input) {
    if (std::ranges::find(inputs_, input) == inputs_.end()) inputs_.push_back(std::move(input));
  }

  std::map<std::string, std::string> copy_of_;  // The name of the copy by the path in the scenario.
  std::vector<InputFile> inputs_;
};

}  // namespace

std::string InputFile::CopyName() const {
  return std::string(kInputsFolder) + "/" + (folder.empty() ? hash : folder) + "/" + name;
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

void WriteScenarioFiles(const ScenarioIdentity& identity,
                        const std::filesystem::path& folder,
                        const std::string& name) {
  MakeFolders(folder);
  for (const InputFile& input : identity.inputs) {
    MakeFolders((folder / input.CopyName()).parent_path());
    WriteFileWhole(folder / input.CopyName(), input.bytes);
  }
  WriteFileWhole(folder / name, identity.scenario_json);
}

void CheckSameFiles(const ScenarioSpec& scenario, const ScenarioIdentity& identity) {
  const ScenarioIdentity now = IdentityOf(scenario);
  for (const InputFile& input : now.inputs) {
    const auto is_same = [&](const InputFile& before) {
      return before.name == input.name && before.hash == input.hash;
    };
    if (std::ranges::any_of(identity.inputs, is_same)) continue;
    throw InputError(input.name + ": was changed while the scenario was read; run it again");
  }
}

ScenarioSpec WithFilesByContent(const ScenarioSpec& scenario) {
  ScenarioSpec anywhere = scenario;
  FileNaming().Rename(anywhere);
  return anywhere;
}

}  // namespace railcast
