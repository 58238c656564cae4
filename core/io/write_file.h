#pragma once

#include <filesystem>
#include <string>
#include <string_view>

#include "core/base/input_file.h"

namespace railcast {

/// The suffix of the name of a file that is still being written.
inline constexpr std::string_view kUnfinishedSuffix = ".part";

/// @throws InputError "rock.obj: must not be written over, since this command reads it" if the file
///   is one of InputFiles() by any name.
void CheckIsNoInput(const std::filesystem::path& file);

/// Returns the file that is replaced when a file is written that the user names: itself or, if it
/// is a symbolic link, the file that it leads to. The link itself stays.
/// @throws InputError if that file, or the unfinished file beside it, exists and is not a regular
///   file: renaming would replace a device or a FIFO by a regular file; or as CheckIsNoInput().
[[nodiscard]] std::filesystem::path FileToReplace(const std::filesystem::path& file);

/// Checks that a file can be written in a folder of railcast's, where a symbolic link would lead to
/// what is not railcast's.
/// @throws InputError "o/run.json: must be a regular file (got a symbolic link)" if the file or
///   the unfinished file beside it is anything else.
void CheckIsOwnFile(const std::filesystem::path& file);

/// Checks whether WriteNamedFile(file) can begin, before the content is computed at great cost.
/// Leaves nothing behind.
/// @throws InputError as WriteNamedFile() does.
void CheckCanWrite(const std::filesystem::path& file);

/// Writes a whole file or none: first to a file beside it (name + kUnfinishedSuffix), which is
/// checked for length, synced to the disk and then renamed. Symbolic links are not followed.
/// @throws InputError as CheckIsOwnFile() does, or if the system refuses; no unfinished file is
///   left.
void WriteFileWhole(const std::filesystem::path& file, std::string_view bytes);

/// As WriteFileWhole(), but for a file that the user names: FileToReplace(file) is written.
/// @throws InputError as FileToReplace() does, or if the system refuses.
void WriteNamedFile(const std::filesystem::path& file, std::string_view bytes);

}  // namespace railcast
