#pragma once

#include <filesystem>
#include <fstream>
#include <string_view>

#include "core/base/error.h"

namespace railcast {

/// "file: no space left on device": what the system said about a file, as an error of the user's.
[[nodiscard]] InputError FileError(const std::filesystem::path& file, int error_number);

/// "a FIFO", "a directory", ...: what a message calls it.
[[nodiscard]] std::string_view NameOf(std::filesystem::file_type type);

/// @throws InputError "file: must be a regular file (got a FIFO)" if `status` is of anything else.
///   A file that is not there, or that we may not look at, is left to the call that opens it.
void CheckIsRegular(const std::filesystem::path& file, const std::filesystem::file_status& status);

/// To be called before a file is opened to be read, however that is done: of a FIFO or a terminal
/// the opening itself waits, perhaps for ever.
/// @throws InputError as CheckIsRegular does, or if the file is not there.
void CheckIsReadable(const std::filesystem::path& file);

/// Opens a file to read its bytes. @throws InputError as CheckIsReadable does, or if the system
///   refuses.
[[nodiscard]] std::ifstream OpenInput(const std::filesystem::path& file);

}  // namespace railcast
