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
    Rename(file, [](const std::filesystem::path& path) { return std::vector{InputOf(path)}; });
  }
  /// A mesh and what is read with it: their copies lie beside each other, too.
  void RenameMesh(std::string& file) {
    if (ShippedFile(file)) return;  // It is the program's.
    Rename(file, [](const std::filesystem::path& path) {
      std::vector<InputFile> inputs = {InputOf(path)};
      for (const FileBeside& beside : FilesBesideMesh(*inputs.front().bytes, path)) {
        inputs.push_back(InputOf(path.parent_path() / beside.name));
      }
      if (inputs.size() == 1) return inputs;
      std::string names_and_hashes;
      for (const InputFile& input : inputs)
        names_and_hashes += input.name + '\n' + input.hash + '\n';
      for (InputFile& input : inputs) input.folder = ContentHash(names_and_hashes);
      return inputs;
    });
  }
  void RenameSurvey(std::string& file) {
    Rename(file, [](const std::filesystem::path& path) {
      NoteInput(path);
      const std::string hash = HashFile(path).hash;
      CheckSurveyFile(path, hash);
      return std::vector<InputFile>{{path.filename().string(), hash, nullptr, path}};
    });
  }
  void Rename(LidarSpec& lidar) {
    if (auto* table = std::get_if<FiringTableSpec>(&lidar.scan.pattern)) Rename(table->file);
    if (lidar.ouster_metadata) Rename(*lidar.ouster_metadata);
  }
  void Rename(ScenarioSpec& scenario) {
    Rename(scenario.lidar);
    for (LidarSpec& lidar : scenario.lidars) Rename(lidar);
    if (auto& elevation = scenario.world.terrain.elevation) Rename(elevation->file);
    if (auto& survey = scenario.world.survey) RenameSurvey(*survey);
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
  static InputFile InputOf(const std::filesystem::path& file) {
    InputBytes bytes = ReadInput(file);
    std::string hash = ContentHash(*bytes);
    return {file.filename().string(), std::move(hash), std::move(bytes)};
  }
  /// @param read Returns the file and those that are read with it.
  void Rename(std::string& file,
              std::vector<InputFile> (*read)(const std::filesystem::path& path)) {
    auto known = copy_of_.find(file);
    if (known == copy_of_.end()) {
      const std::vector<InputFile> inputs = read(file);
      known = copy_of_.emplace(file, inputs.front().CopyName()).first;
      // The same file may lie in two folders but is stored once.
      for (const InputFile& input : inputs) {
        if (std::ranges::find(inputs_, input) == inputs_.end()) inputs_.push_back(input);
      }
    }
    file = known->second;
  }

  std::map<std::string, std::string> copy_of_;  // The name of the copy by the path in the scenario.
  std::vector<InputFile> inputs_;
};

}  // namespace

std::string InputFile::CopyName() const {
  return std::string(kInputsFolder) + "/" + (folder.empty() ? hash : folder) + "/" + name;
}

bool InputFile::operator==(const InputFile& other) const {
  return name == other.name && hash == other.hash && folder == other.folder;
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
  for (const InputFile& input : identity.inputs) WriteFixedFile(folder, input.Copy());
  WriteFileWhole(folder / name, identity.scenario_json);
}

ScenarioSpec WithFilesByContent(const ScenarioSpec& scenario) {
  ScenarioSpec anywhere = scenario;
  FileNaming().Rename(anywhere);
  return anywhere;
}

}  // namespace railcast
