#pragma once

#include <filesystem>
#include <set>
#include <vector>

#include "core/base/error.h"
#include "core/base/text.h"

namespace railcast {

/// Checks that no source is given twice, since its samples would be counted twice and the intervals
/// would be too narrow.
/// @throws InputError if two paths lead to the same source.
inline void CheckDistinct(const std::vector<std::filesystem::path>& sources) {
  std::set<std::filesystem::path> seen;
  for (const std::filesystem::path& source : sources) {
    if (seen.insert(std::filesystem::weakly_canonical(source)).second) continue;
    throw InputError(ShownPath(source) + ": must be named once");
  }
}

}  // namespace railcast
