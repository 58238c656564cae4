#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "core/base/inputs.h"
#include "core/io/run/fixed_file.h"
#include "railcast/scenario.h"

namespace railcast {

/// A file that a run reads besides the scenario's JSON, as it was when it was read: a mesh, a
/// firing table, a grid of heights, a survey, or a file that is read with a mesh.
struct InputFile {
  std::string name;  ///< File name without its folder.
  std::string hash;  ///< ContentHash of its bytes.
  InputBytes bytes;  ///< The whole content; null of a survey, which may be of any size.
  std::filesystem::path copy_of{};  ///< The survey.
  /// If a mesh is read with others beside it: the one hash of them all. Empty = the file's own.
  std::string folder{};

  /// Returns the path under which a sequence directory keeps the file, relative to that directory:
  /// "inputs/0123456789abcdef/rock.obj".
  [[nodiscard]] std::string CopyName() const;
  /// The copy.
  [[nodiscard]] FixedFile Copy() const { return {CopyName(), bytes, copy_of, hash}; }

  /// Whether the names, contents and folders are equal.
  bool operator==(const InputFile& other) const;
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

/// Returns the scenario with its files named by InputFile::CopyName(), so that two scenarios that
/// differ only in where equal files lie become equal.
/// @throws InputError if a named file cannot be read.
[[nodiscard]] ScenarioSpec WithFilesByContent(const ScenarioSpec& scenario);

}  // namespace railcast
