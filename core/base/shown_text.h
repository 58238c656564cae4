#pragma once

#include <filesystem>
#include <string>
#include <string_view>

namespace railcast {

/// A text from outside as a message shows it: on one line, harmless to a terminal and not endless.
/// Control characters become \n, \r, \t or \u001b, what is no UTF-8 becomes \xff, and what is
/// longer than 60 bytes is cut and ends in "...".
[[nodiscard]] std::string ShownText(std::string_view text);

/// A file's name in the same way, but whole: on one line, whatever is in it.
[[nodiscard]] std::string ShownPath(const std::filesystem::path& path);

/// What is printed, in the same way, but whole and with its line breaks: the last to see a message
/// before the terminal does.
[[nodiscard]] std::string ShownLines(std::string_view text);

}  // namespace railcast
