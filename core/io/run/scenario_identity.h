#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "railcast/scenario.h"

namespace railcast {

/// A file that a run reads besides the scenario's JSON, as it was when it was read: a mesh, a
/// firing table, a grid of heights, or a file that is read with a mesh.
struct InputFile {
  std::string name;   ///< File name without its folder.
  std::string hash;   ///< ContentHash of its bytes.
  std::string bytes;  ///< The whole content.
  /// If a mesh is read with others beside it: the one hash of them all. Empty = the file's own.
  std::string folder{};

  /// Returns the path under which a sequence directory keeps the file, relative to that directory:
  /// "inputs/0123456789abcdef/rock.obj".
  [[nodiscard]] std::string CopyName() const;

  bool operator==(const InputFile&) const = default;
};

/// Identifies a scenario by what it states and by the content of all files that it is read with,
/// wherever those files lie. Two scenarios are the same if their identities are equal.
struct ScenarioIdentity {
  std::string scenario_json;  ///< Resolved, with files named by InputFile::CopyName().
  std::string scenario_hash;  ///< ContentHash of scenario_json.
  /// Each file once, in the order in which the scenario first names it, or the mesh that names it.
  std::vector<InputFile> inputs;

  bool operator==(const ScenarioIdentity&) const = default;
};

/// Returns a scenario's identity. A scenario read back from a sequence directory has the identity
/// of the one that the directory was made from.
/// @throws InputError if a named file cannot be read, or a survey is not what its record says.
[[nodiscard]] ScenarioIdentity IdentityOf(const ScenarioSpec& scenario);

/// Writes a scenario, or a plan, and the files that it names into a folder, which is created.
/// @param name Of the JSON file in the folder.
void WriteScenarioFiles(const ScenarioIdentity& identity,
                        const std::filesystem::path& folder,
                        const std::string& name);

/// Checks that the files of a scenario have not been edited between two readings.
/// @throws InputError if a file that the scenario names has other content than in `identity`.
void CheckSameFiles(const ScenarioSpec& scenario, const ScenarioIdentity& identity);

/// Returns the scenario with its files named by InputFile::CopyName(), so that two scenarios that
/// differ only in where equal files lie become equal.
/// @throws InputError if a named file cannot be read.
[[nodiscard]] ScenarioSpec WithFilesByContent(const ScenarioSpec& scenario);

}  // namespace railcast
