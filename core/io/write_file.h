#pragma once

#include <filesystem>
#include <string>
#include <string_view>

#include "core/base/input_file.h"

namespace railcast {

/// The suffix of the name of a file that is still being written.
inline constexpr std::string_view kUnfinishedSuffix = ".part";

/// Returns the file that is replaced when `file` is written: itself or, if it is a symbolic link,
/// the file that it leads to. The link itself stays.
/// @throws InputError if that file, or the unfinished file beside it, exists and is not a regular
///   file: renaming would replace a device or a FIFO by a regular file.
[[nodiscard]] std::filesystem::path FileToReplace(const std::filesystem::path& file);

/// Checks whether WriteFileWhole(file) can begin, before the content is computed at great cost.
/// Leaves nothing behind.
/// @throws InputError as WriteFileWhole() does.
void CheckCanWrite(const std::filesystem::path& file);

/// Writes a whole file or none: first to a file beside it (name + kUnfinishedSuffix), which is
/// checked for length, synced to the disk and then renamed over FileToReplace(file).
/// @throws InputError as FileToReplace() does, or if the system refuses; no unfinished file is
///   left.
void WriteFileWhole(const std::filesystem::path& file, std::string_view bytes);

}  // namespace railcast
