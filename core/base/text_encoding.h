#pragma once

#include <filesystem>
#include <string>
#include <string_view>

namespace railcast {

/// The text as UTF-8 without a byte order mark. Text in UTF-16, as PowerShell and Excel write it,
/// is known by its mark or by the zero beside its first letter; what is no text of these stays as
/// it is. Half a surrogate pair becomes the replacement character.
[[nodiscard]] std::string AsUtf8(std::string bytes);

/// Whether bytes that should be text are UTF-16, as AsUtf8() knows it.
[[nodiscard]] bool IsUtf16(std::string_view bytes);

/// The bytes behind the byte order mark of UTF-8, if there is one.
[[nodiscard]] std::string_view WithoutMark(std::string_view bytes);

/// The text with the letters A to Z as a to z.
[[nodiscard]] std::string LowerCase(std::string_view text);

/// A whole input, AsUtf8().
/// @throws InputError as ReadInput() does.
[[nodiscard]] std::string ReadTextWhole(const std::filesystem::path& file);

}  // namespace railcast
