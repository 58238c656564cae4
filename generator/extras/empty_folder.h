#pragma once

#include <filesystem>

#include "core/base/error.h"
#include "core/base/text.h"
#include "core/io/run/run_folder.h"

namespace railcast {

/// Makes the folder of `--out` if there is none, and locks it.
/// @throws InputError if it is not empty, or as FolderLock and CheckIsOutside().
[[nodiscard]] inline FolderLock LockEmptyFolder(const std::filesystem::path& folder) {
  CheckIsOutside("--out", folder, true);
  FolderLock lock(folder);
  if (std::filesystem::is_empty(folder)) return lock;
  throw InputError("--out: must be a new or an empty folder (got " + ShownPath(folder) + ")");
}

}  // namespace railcast
