#pragma once

#include <filesystem>
#include <string>
#include <string_view>

#include "core/base/input_file.h"

namespace railcast {

/// Ends the name of a file that is still being written.
inline constexpr std::string_view kUnfinishedSuffix = ".part";

/// The file that is replaced when `file` is written: itself, or what it leads to as a symbolic
/// link. The link stays.
/// @throws InputError if there, or where the unfinished file goes, is anything but a regular file.
///   Renamed over a device or a FIFO, a file would take its place.
[[nodiscard]] std::filesystem::path FileToReplace(const std::filesystem::path& file);

/// Tries whether WriteFileWhole(file) can begin, so that what takes long to make is not made in
/// vain. Leaves nothing behind.
/// @throws InputError as that does.
void CheckCanWrite(const std::filesystem::path& file);

/// Writes a whole file or none: beside it first (name + kUnfinishedSuffix), checked for length,
/// synced to the disk, then renamed over FileToReplace(file).
/// @throws InputError as that does, or if the system refuses; nothing unfinished stays behind.
void WriteFileWhole(const std::filesystem::path& file, std::string_view bytes);

/// The bytes of a whole file. @throws InputError if it is no regular file or cannot be read.
[[nodiscard]] std::string ReadFileWhole(const std::filesystem::path& file);

}  // namespace railcast
