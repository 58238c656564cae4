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

/// Refuses a folder that holds anything but known entries; one that is not there holds nothing.
/// @param is_known Called with the name of each entry.
/// @param known What may be there, for the message.
/// @throws InputError "FOLDER: must hold nothing but KNOWN (got "photos")".
template <typename IsKnown>
void RefuseOtherEntries(const std::filesystem::path& folder,
                        const IsKnown& is_known,
                        const std::string& known) {
  std::error_code none;
  for (const auto& entry : std::filesystem::directory_iterator(folder, none)) {
    const std::string name = entry.path().filename().string();
    if (is_known(name)) continue;
    throw InputError(ShownPath(folder) + ": must hold nothing but " + known + " (got " +
                     Quoted(name) + ")");
  }
}

}  // namespace railcast
