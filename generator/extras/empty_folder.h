#pragma once

#include <filesystem>
#include <string>
#include <system_error>

#include "core/base/error.h"
#include "core/base/text.h"

namespace railcast {

/// Makes the folder of `--out` if there is none.
/// @throws InputError if that fails or if it is not empty.
inline void MakeEmptyFolder(const std::filesystem::path& folder) {
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
