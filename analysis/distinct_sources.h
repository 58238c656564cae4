#pragma once

#include <filesystem>
#include <set>
#include <vector>

#include "core/base/error.h"
#include "core/base/shown_text.h"

namespace railcast {

/// Samples that are counted twice would look like twice as many.
/// @throws InputError if a source is named twice, by whatever path.
inline void CheckDistinct(const std::vector<std::filesystem::path>& sources) {
  std::set<std::filesystem::path> seen;
  for (const std::filesystem::path& source : sources) {
    if (seen.insert(std::filesystem::weakly_canonical(source)).second) continue;
    throw InputError(ShownPath(source) + ": must be named once");
  }
}

}  // namespace railcast
