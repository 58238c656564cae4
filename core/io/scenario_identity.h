#pragma once

#include <string>
#include <vector>

#include "core/scenario/scenario_spec.h"

namespace railcast {

/// A mesh or a firing table that a scenario names, as it was when it was read.
struct InputFile {
  std::string name;   ///< Without its folder.
  std::string hash;   ///< ContentHash of its bytes.
  std::string bytes;  ///< All of them.

  /// Where a sequence directory keeps it, relative to the directory:
  /// "inputs/0123456789abcdef/rock.obj".
  [[nodiscard]] std::string CopyName() const;

  bool operator==(const InputFile&) const = default;
};

/// What makes two scenarios the same: what they say and what the files they name hold, wherever
/// those lie.
struct ScenarioIdentity {
  std::string scenario_json;      ///< Resolved, with files named by InputFile::CopyName().
  std::string scenario_hash;      ///< ContentHash of that.
  std::vector<InputFile> inputs;  ///< Each once, in the order the scenario first names them.

  bool operator==(const ScenarioIdentity&) const = default;
};

/// A scenario read back from a sequence directory has the identity of the one that the directory
/// was made of.
/// @throws InputError if a named file cannot be read.
[[nodiscard]] ScenarioIdentity IdentityOf(const ScenarioSpec& scenario);

/// @throws InputError if a file that the scenario names has another content than that of
/// `identity`:
///   somebody edited it between two readings.
void CheckSameFiles(const ScenarioSpec& scenario, const ScenarioIdentity& identity);

/// The scenario with its files named by InputFile::CopyName(): two that differ only in where equal
/// files lie become equal.
/// @throws InputError if a named file cannot be read.
[[nodiscard]] ScenarioSpec WithFilesByContent(const ScenarioSpec& scenario);

}  // namespace railcast
