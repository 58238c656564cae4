#pragma once

#include <filesystem>
#include <string>

namespace railcast {

/// The text as UTF-8 without a byte order mark. Text in UTF-16, as PowerShell and Excel write it,
/// is known by its mark or by the zero beside its first letter; what is no text of these stays as
/// it is. Half a surrogate pair becomes the replacement character.
[[nodiscard]] std::string AsUtf8(std::string bytes);

/// The whole file, AsUtf8().
/// @throws InputError as ReadFileWhole() does.
[[nodiscard]] std::string ReadTextWhole(const std::filesystem::path& file);

}  // namespace railcast
