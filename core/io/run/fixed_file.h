#pragma once

#include <filesystem>
#include <string>

#include "core/base/inputs.h"

namespace railcast {

/// A file in the folder of a run that is known before the first frame.
struct FixedFile {
  std::string name;                 ///< Relative to the folder.
  InputBytes bytes;                 ///< Its content; null: that of the next.
  std::filesystem::path copy_of{};  ///< A file of any size, which is not held in memory.
  std::string hash{};               ///< ContentHash() of the content; empty: not known yet.
};

/// A file of text that the program makes.
[[nodiscard]] FixedFile FixedText(std::string name, std::string text);

/// Whether a folder holds the file with its content.
/// @throws InputError if either cannot be read.
[[nodiscard]] bool HasFixedFile(const std::filesystem::path& folder, const FixedFile& file);

/// Writes a file into a folder, unless it is there.
/// @param twin A folder of the same run that has the file by now, to which it becomes a hard link
///   where the file system has them; empty = none.
/// @throws InputError as WriteFileWhole() does; "FILE: was changed while the scenario was read; run
///   it again" if `copy_of` no longer has the hash.
void WriteFixedFile(const std::filesystem::path& folder,
                    const FixedFile& file,
                    const std::filesystem::path& twin = {});

}  // namespace railcast
