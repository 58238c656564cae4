#pragma once

#include <filesystem>
#include <string>
#include <system_error>

#include "core/base/error.h"
#include "core/base/text.h"
#include "core/io/run/run_folder.h"

namespace railcast {

/// Makes the folder of `--out` if there is none.
/// @throws InputError if that fails, if it is not empty or as CheckIsOutside().
inline void MakeEmptyFolder(const std::filesystem::path& folder) {
  CheckIsOutside("--out", folder, true);
  std::error_code error;
  std::filesystem::create_directories(folder, error);
  if (error) {
    throw InputError(ShownPath(folder) + ": cannot make the folder: " + error.message());
  }
  if (!std::filesystem::is_empty(folder)) {
    throw InputError("--out: must be a new or an empty folder (got " + ShownPath(folder) + ")");
  }
}

}  // namespace railcast
