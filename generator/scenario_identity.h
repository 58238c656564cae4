#pragma once

#include <string>
#include <vector>

#include "core/scenario/scenario_spec.h"

namespace railcast {

/// A mesh or a firing table that a scenario names.
struct InputFile {
  std::string name;  ///< Without its folder.
  std::string hash;  ///< ContentHash of its bytes.

  bool operator==(const InputFile&) const = default;
};

/// What makes two scenarios the same: what they say and what the files they name hold, wherever
/// those lie.
struct ScenarioIdentity {
  std::string scenario_hash;      ///< Of the resolved scenario, file names replaced by contents.
  std::vector<InputFile> inputs;  ///< Each once, in the order the scenario first names them.
};

/// @throws InputError if a named file cannot be read.
[[nodiscard]] ScenarioIdentity IdentityOf(const ScenarioSpec& scenario);

}  // namespace railcast
