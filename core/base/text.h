#pragma once

#include <array>
#include <charconv>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <iomanip>
#include <optional>
#include <sstream>
#include <string>
#include <string_view>
#include <system_error>
#include <type_traits>
#include <vector>

namespace railcast {

/// The shortest text that reads back as the same number: 29556.1, not 29556.100000.
template <typename Number>
[[nodiscard]] std::string NumberText(Number number) {
  std::array<char, 32> digits{};
  return {digits.data(), std::to_chars(digits.data(), digits.data() + digits.size(), number).ptr};
}

[[nodiscard]] constexpr bool IsDigit(char letter) {
  return letter >= '0' && letter <= '9';
}

/// The suffix " (got 29556.1)" of a message about a number that violates a rule.
template <typename Number>
requires std::is_arithmetic_v<Number>
[[nodiscard]] std::string Got(Number number) {
  return " (got " + NumberText(number) + ")";
}

/// Formats a number with four significant digits, such as 0.0001234.
[[nodiscard]] inline std::string ShortText(double value) {
  std::ostringstream text;
  text << std::setprecision(4) << value;
  return text.str();
}

/// Formats a time as "5.4 s". Divides by 1e9, unlike SecondsFromNs: multiplying by 1e-9 would give
/// 0.30000000000000004.
[[nodiscard]] inline std::string SecondsText(std::int64_t time_ns) {
  return NumberText(static_cast<double>(time_ns) / 1e9) + " s";
}

/// Makes external text safe to show in a message: on a single line, harmless to a terminal and of
/// limited length. Control characters become \n, \r, \t or \u001b, invisible ones such as those
/// that turn the direction of text \u202e, invalid UTF-8 bytes \xff, and text longer than 60 bytes
/// is cut off and ends in "...".
[[nodiscard]] std::string ShownText(std::string_view text);

/// As ShownText(), for a file name: on a single line, but not shortened.
[[nodiscard]] std::string ShownPath(const std::filesystem::path& path);

/// As ShownText(), but not shortened and with line breaks kept. Applied to every message just
/// before it is printed.
[[nodiscard]] std::string ShownLines(std::string_view text);

/// Levenshtein distance (1966): the minimum number of insertions, deletions and substitutions of
/// characters that turn one name into the other. Used to suggest what a misspelt word may have
/// meant.
[[nodiscard]] std::size_t EditDistance(std::string_view a, std::string_view b);

/// The text as ShownText() shows it, in double quotes.
[[nodiscard]] inline std::string Quoted(std::string_view text) {
  return '"' + ShownText(text) + '"';
}

/// Takes the next line off `text`, without its end (LF or CR LF); returns nothing if none is left.
[[nodiscard]] inline std::optional<std::string_view> TakeLine(std::string_view& text) {
  if (text.empty()) return std::nullopt;
  const std::size_t end = text.find('\n');
  std::string_view line = text.substr(0, end);
  text.remove_prefix(end == std::string_view::npos ? text.size() : end + 1);
  if (!line.empty() && line.back() == '\r') line.remove_suffix(1);
  return line;
}

/// Splits a line into its words, which are separated by blanks.
[[nodiscard]] inline std::vector<std::string_view> Words(std::string_view line) {
  std::vector<std::string_view> words;
  while (true) {
    const std::size_t begin = line.find_first_not_of(" \t");
    if (begin == std::string_view::npos) return words;
    line.remove_prefix(begin);
    const std::size_t end = line.find_first_of(" \t");
    words.push_back(line.substr(0, end));
    if (end == std::string_view::npos) return words;
    line.remove_prefix(end);
  }
}

/// Parses the whole word as a number; returns nothing if it is not one or does not fit the type.
template <typename Number>
[[nodiscard]] std::optional<Number> ParseNumber(std::string_view word) {
  Number number{};
  const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), number);
  if (error != std::errc{} || end != word.data() + word.size()) return std::nullopt;
  return number;
}

/// As ParseNumber(), with a plus sign allowed before the number, which from_chars() rejects. "+-1"
/// is no number.
template <typename Number>
[[nodiscard]] std::optional<Number> ParseSignedNumber(std::string_view word) {
  if (word.starts_with('+') && !word.starts_with("+-")) word.remove_prefix(1);
  return ParseNumber<Number>(word);
}

}  // namespace railcast
