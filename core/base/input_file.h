#pragma once

#include <filesystem>
#include <fstream>
#include <string>
#include <string_view>

#include "core/base/error.h"

namespace railcast {

/// The system's error message about a file as an InputError: "file: no space left on device".
[[nodiscard]] InputError FileError(const std::filesystem::path& file, int error_number);

/// Name of a file type for messages: "a FIFO", "a directory", ...
[[nodiscard]] std::string_view NameOf(std::filesystem::file_type type);

/// @throws InputError "file: must be a regular file (got a FIFO)" if `status` describes any other
///   type. A file that does not exist or cannot be examined passes; the call that opens it reports
///   the error.
void CheckIsRegular(const std::filesystem::path& file, const std::filesystem::file_status& status);

/// Must be called before a file is opened for reading by any means: opening a FIFO or a terminal
/// can block indefinitely.
/// @throws InputError as CheckIsRegular does, or if the file does not exist.
void CheckIsReadable(const std::filesystem::path& file);

/// Opens a file for reading in binary mode.
/// @throws InputError as CheckIsReadable does, or if the system refuses.
[[nodiscard]] std::ifstream OpenInput(const std::filesystem::path& file);

/// Returns the bytes of a whole file.
/// @throws InputError as OpenInput does, or if the system refuses to read it.
[[nodiscard]] std::string ReadFileWhole(const std::filesystem::path& file);

}  // namespace railcast
